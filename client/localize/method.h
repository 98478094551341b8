// The interface between a localizer and a localization method.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "client/localize/estimate.h"
#include "client/localize/query.h"
#include "client/localize/tile_window.h"
#include "schema/base/result.h"
#include "schema/geo/camera.h"

namespace milepost {

class Relocalizer;
struct SegmentLayer;

// Settings common to all methods.
struct MethodSettings {
  int min_start_support = 6;  // inlier tracklets or landmarks for a start
  WindowReach reach;
  // Called by localize() for each estimate of a frame tracked by tracklets or landmarks; may be
  // empty.
  std::function<void(const TrackletEstimate&)> on_estimate = {};
};

// Creates the relocalizer of one segment. Errors: corrupt (the layer holds other items than the
// method needs).
using MakeRelocalizer = std::function<Result<std::unique_ptr<Relocalizer>>(
    const std::shared_ptr<const SegmentLayer>& layer, const Camera& camera,
    const MethodSettings& settings)>;

struct Method {
  std::string name;
  std::string layer;  // of the map that it needs
  MakeRelocalizer make_relocalizer;
  bool relocalizes_while_tracking = false;  // to check the tracked pose from time to time
};

}  // namespace milepost
