// What a build maps: the road network of all drives, and the stretches of each drive that carry the
// segments' lines and landmarks.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/network/road_network.h"
#include "mapper/pipeline/settings.h"
#include "mapper/pipeline/stretch_plan.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/store/map_store.h"

namespace milepost {

// Each drive that is mapped; a copy of another one is not.
struct DrivePlan {
  const Drive* drive = nullptr;
  std::vector<StretchPlan> stretches;  // that carry a segment, or landmarks of one

  std::size_t frames() const;  // of all stretches
};

// A segment, and the places where drives passed it whose landmarks are mapped.
struct FusedSegment {
  struct PassPlace {
    std::size_t stretch = 0;  // counted over all drives, in the order of the plan
    AlongRange on_stretch;
  };

  std::string id;
  RouteLine line;
  std::vector<PassPlace> passes;
};

struct BuildPlan {
  std::vector<DrivePlan> drives;        // by name
  std::vector<StoredSegment> segments;  // by id
  std::vector<FusedSegment> fused;      // the same segments
  std::set<std::string> beyond_border;  // ids of the segments right of the border
  std::vector<Finding> findings;        // about the drives and their network
};

// About the drives' ways alone, before they are made a network: copies of one recording, pauses,
// reversing. Errors: as plan_build, but for images.
Result<std::vector<Finding>> line_findings(const std::vector<Drive>& drives,
                                           const BuildSettings& settings);

// The plan does not depend on the order of the drives. REQUIRES: the drives outlive it. Errors:
// invalid_input (two drives of one name, a name that is not an id, a drive that does not move);
// those of FrameReader::gray where passes are compared.
Result<BuildPlan> plan_build(const std::vector<Drive>& drives, const BuildSettings& settings,
                             int jobs);

}  // namespace milepost
