// The frames of a drive that are mapped in one go, their line, and the segments that are cut from
// it.
#pragma once

#include <string>
#include <vector>

#include "schema/base/range.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/geo/route_line.h"
#include "schema/store/map_store.h"

namespace milepost {

// A segment whose line is a part of a stretch's line.
struct SegmentCut {
  std::string id;
  AlongRange on_stretch;  // arc lengths of the stretch's line
  RouteLine line;         // of the segment, from 0
};

// A stretch that a drive drove without a pause. Features are tracked and poses adjusted over all of
// it; cuts only decide to which segment a landmark belongs.
struct StretchPlan {
  std::vector<std::size_t> frame_indices;  // one per vertex of the line
  RouteLine line;
  std::vector<SegmentCut> segments;  // in driving order, disjoint
};

// Frames closer than `min_spacing_m` to the last selected one are skipped: the frames of a stopped
// vehicle carry no information on scale against position. The whole drive becomes one segment, or,
// with `cuts_m`, arc lengths that ascend, one more than these. Errors: invalid_input (a name that
// is not a segment id, or a drive that does not move).
Result<StretchPlan> plan_stretch(const Drive& drive, double min_spacing_m,
                                 const std::vector<double>& cuts_m = {});

// The part of a line. REQUIRES: a range of positive length within [0, length].
RouteLine part_of(const RouteLine& line, const AlongRange& range);

StoredSegment stored_segment(const SegmentCut& segment);

}  // namespace milepost
