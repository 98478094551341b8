// The lines of a map's segments, found by proximity to a position.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schema/geo/near.h"
#include "server/catalog/box_tree.h"

namespace milepost::server {

struct SegmentLine {
  std::string segment;
  double length_m = 0;  // as the map states it
  BoxedLine line;
};

struct NearLine {
  const SegmentLine* line = nullptr;
  LineProjection projection;
};

// Immutable, so safe to share between threads.
class MapLines {
 public:
  // REQUIRES: ascending by the segments' ids.
  explicit MapLines(std::vector<SegmentLine> lines);

  // The segments that pass within the radius, in the order of their ids.
  std::vector<NearLine> near(const GeoPoint& position, double radius_m) const;
  // REQUIRES: the map has the segment.
  const RouteLine& line(const std::string& segment) const;
  // Around all lines; may cross longitude 180. Nothing if there are none.
  const std::optional<Bounds>& bounds() const { return bounds_; }
  std::uint64_t memory_bytes() const { return memory_bytes_; }  // about

 private:
  std::vector<SegmentLine> lines_;
  BoxTree tree_;
  std::optional<Bounds> bounds_;
  std::uint64_t memory_bytes_ = 0;
};

}  // namespace milepost::server
