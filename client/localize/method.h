// How a localizer recognizes places: the seam between it and a method.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "client/localize/estimate.h"
#include "client/localize/query.h"
#include "client/localize/tile_window.h"
#include "schema/base/result.h"
#include "schema/geo/pinhole.h"

namespace milepost {

class Scout;
struct SegmentLayer;

// What every method is told.
struct ScoutSettings {
  int min_start_support = 6;  // tracklets or landmarks that must agree before a start is weighed
  WindowReach reach;
  // Called by localize() for each estimate of a frame that is followed by tracklets or landmarks;
  // may be empty.
  std::function<void(const TrackletEstimate&)> on_estimate = {};
};

// A scout for one segment. REQUIRES: the layer outlives the scout and its followers.
// Errors: corrupt (the layer holds other items than the method needs).
using MakeScout = std::function<Result<std::unique_ptr<Scout>>(
    const SegmentLayer& layer, const Camera& camera, const ScoutSettings& settings)>;

struct Method {
  std::string name;
  std::string layer;  // of the map, that it needs
  MakeScout make_scout;
  bool looks_again = false;  // while a place is followed, its pose is found anew now and then
};

}  // namespace milepost
