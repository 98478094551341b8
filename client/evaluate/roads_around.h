// The map's roads around a drive, for the plan of the report.
#pragma once

#include <vector>

#include "client/evaluate/evaluation.h"
#include "client/fetch/map_source.h"
#include "client/fetch/wants.h"
#include "schema/drive/drive.h"

namespace milepost {

struct RoadAround {
  SegmentKey segment;
  double length_m = 0;
  std::vector<GeoPoint> line;
  bool is_driven = false;  // a fix is on it
  // Whether it joins other segments at its begin, or parts into several at its end.
  bool begins_at_junction = false;
  bool ends_at_junction = false;
};

// The segments with a fix and those that pass near the drive, in the order of their keys. Errors:
// those of MapSource::segments_near, and of MapSource::segment for those with a fix; others that
// cannot be read are left out.
Result<std::vector<RoadAround>> roads_around(const Drive& drive,
                                             const std::vector<MethodEvaluation>& methods,
                                             MapSource& source);

}  // namespace milepost
