// Estimates the sun's azimuth from the shadows of a picture.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "mapper/aerial/regions.h"

namespace milepost {

// Accumulates the direction of shadows over the blocks of a picture. Compact regions, most of them
// roofs, are dark beyond the sides on which their shadows fall: this gives a coarse direction,
// since a side is in shade at any angle. The borders of a shadow that start at a roof's outermost
// corners are parallel to the light: this gives an accurate direction.
class SunEvidence {
 public:
  void add(const RegionMap& map);

  // The sun's azimuth, clockwise from north; none if the shadows do not agree on one.
  std::optional<double> azimuth_deg() const;

 private:
  static constexpr int kDirections = 180;

  std::optional<double> rough_azimuth_deg() const;
  // Averaged around a direction of the light: how well borders of shadows align with it.
  double border_at(int direction) const;

  Eigen::Vector2d shaded_sides_ = Eigen::Vector2d::Zero();  // east, north: sum of normals
  double shaded_m_ = 0;                                     // length of shaded outline
  std::array<double, kDirections> borders_{};               // by azimuth, two degrees apart
};

}  // namespace milepost
