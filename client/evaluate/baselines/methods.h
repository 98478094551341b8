// The methods that can be compared: those of the tracklet paper as published, our previous one, and
// the default.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "client/evaluate/baselines/arc_length_tracker.h"
#include "client/evaluate/baselines/matching.h"
#include "client/evaluate/baselines/scale_change.h"
#include "client/localize/estimate.h"
#include "client/localize/method.h"
#include "schema/base/result.h"

namespace milepost {

enum class Combination { mean, robust };

// Localizes by the tracklets that a frame's features match.
struct TrackletMethod {
  MatchSettings match;
  Combination combination = Combination::robust;
  double min_sigma_m = 0.05;  // lower bound of the mean's sigma
  RobustSettings robust;      // also used for the start of every method
  IndexSettings index;
  std::variant<PaperTrackerSettings, MotionTrackerSettings> tracker;
};

// The comparison of two frames: the distance of whole-image descriptors, or the change of matched
// features' scales.
enum class FrameComparison { image, scale };

// Localizes by dynamic time warping of the driven frames onto the map's frames.
struct WarpMethod {
  FrameComparison comparison = FrameComparison::image;
  ScaleChangeSettings scale;
  double unmatched_cost = 1;  // of frames that cannot be compared
  double max_speed_mps = 50;  // bounds the step from frame to frame ...
  double min_step_m = 5;      // ... lower bound of that bound, for high frame rates
  IndexSettings index;        // over the features of each frame of the map
  double band_m = 10;         // of the map's frames, beyond the largest step
};

// By tracklets: matching, combination of the estimates, a tracker.
MakeRelocalizer tracklet_relocalizers(const TrackletMethod& method);

// By whole frames: dynamic time warping.
MakeRelocalizer warp_relocalizers(const WarpMethod& method);

// The names of all methods, the papers' first and the default last.
std::vector<std::string> method_names();

// Errors: invalid_input (no such method; the message lists all methods).
Result<Method> method_named(const std::string& name);

// The paper's combination: mean (Eq. 4) and spread (Eq. 5) of all estimates, equally weighted. None
// without estimates. The floor `min_sigma_m` keeps a single estimate from being certain.
std::optional<Measurement> combine_by_mean(const std::vector<PositionEstimate>& estimates,
                                           double min_sigma_m);

// Combines estimates as the method does.
std::optional<Measurement> combine(const std::vector<PositionEstimate>& estimates,
                                   const TrackletMethod& method);

std::unique_ptr<ArcLengthTracker> make_tracker(const TrackletMethod& method);

}  // namespace milepost
