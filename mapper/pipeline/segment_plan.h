// Selects the frames of a drive that form a segment, and the segment's line.
#pragma once

#include <string>
#include <vector>

#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/geo/route_line.h"
#include "schema/store/map_store.h"

namespace milepost {

struct SegmentPlan {
  std::string id;                          // the drive's name
  std::vector<std::size_t> frame_indices;  // one per vertex of the line
  RouteLine line;
};

// Frames closer than `min_spacing_m` to the last selected one are skipped: the frames of a stopped
// vehicle carry no information on scale against position. Errors: invalid_input (a name that is not
// a segment id, or a drive that does not move).
Result<SegmentPlan> plan_segment(const Drive& drive, double min_spacing_m);

StoredSegment stored_segment(const SegmentPlan& plan);

}  // namespace milepost
