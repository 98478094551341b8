// The segments around one segment, unrolled into its arc length.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "client/fetch/held_map.h"
#include "client/fetch/segment_layer.h"
#include "schema/base/range.h"

namespace milepost {

// How a segment is reached from the current one.
enum class RoadSide {
  current,
  ahead,   // by successors only
  behind,  // by predecessors only
  beside,  // a branch that parts from, or joins, the same junction
};

struct UnrolledSegment {
  std::shared_ptr<const SegmentLayer> layer;
  double offset_m = 0;  // arc length a of it lies at a + offset_m of the current segment's way
  RoadSide side = RoadSide::current;
  int junctions = 0;  // between the current segment and this one
  // Whether the way between it and the current segment is the one that each segment's line takes:
  // its first successor.
  bool is_main_way = true;

  AlongRange extent() const { return {offset_m, offset_m + layer->line.length_m()}; }
};

// The held segments that a vehicle on the current one reaches within `range` of its arc length,
// the current one first, then by the number of junctions between. Each is listed once.
std::vector<UnrolledSegment> unrolled_road(const HeldMap& held,
                                           const std::shared_ptr<const SegmentLayer>& current,
                                           const AlongRange& range);

// The version of a successor's map: that of the segment itself, or, in another map, the version
// that is listed around, held, or in the catalog. None while it is not known.
std::optional<SegmentKey> key_of(const Successor& successor, const SegmentLayer& from,
                                 const HeldMap& held);

}  // namespace milepost
