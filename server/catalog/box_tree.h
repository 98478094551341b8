// Boxes on the Earth, found by proximity to a position.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "schema/base/cell_grid.h"
#include "schema/geo/geodesy.h"

namespace milepost::server {

// An R-tree. Immutable, so safe to share between threads.
class BoxTree {
 public:
  // A box may cross longitude 180.
  explicit BoxTree(const std::vector<Bounds>& boxes);
  ~BoxTree();
  BoxTree(BoxTree&&) noexcept;
  BoxTree& operator=(BoxTree&&) noexcept;

  // The numbers of all boxes with a point within the radius, and of some beyond; ascending.
  std::vector<std::size_t> near(const GeoPoint& position, double radius_m) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace milepost::server
