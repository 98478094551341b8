// The frames of a drive that are mapped in one go, their line, and the segments that are cut from
// it.
#pragma once

#include <string>
#include <vector>

#include "schema/base/range.h"
#include "schema/geo/route_line.h"

namespace milepost {

// A segment whose line is a part of a stretch's line.
struct SegmentCut {
  std::string id;
  AlongRange on_stretch;  // arc lengths of the stretch's line
  RouteLine line;         // of the segment, from 0
};

// A pass whose landmarks are mapped.
struct MappedPass {
  std::size_t segment = 0;  // index of the plan's segments
  std::size_t pass = 0;     // index of the segment's passes
  AlongRange on_stretch;
  bool is_line = false;  // whether the segment takes its line
};

// A stretch that a drive drove without a pause. Features are tracked and poses adjusted over all of
// it; cuts only decide to which segment a landmark belongs.
struct StretchPlan {
  std::vector<std::size_t> frame_indices;  // one per vertex of the line
  RouteLine line;
  std::vector<SegmentCut> segments;  // in driving order, disjoint
  std::vector<MappedPass> passes;    // the same
};

// The part of a line. REQUIRES: a range of positive length within [0, length].
RouteLine part_of(const RouteLine& line, const AlongRange& range);

}  // namespace milepost
