// The methods that can be compared, and what each is made of: those of the tracklet paper, as
// published, ours before landmarks, and the default.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "client/evaluate/baselines/matching.h"
#include "client/evaluate/baselines/scale_change.h"
#include "client/evaluate/baselines/tracker.h"
#include "client/localize/estimate.h"
#include "client/localize/method.h"
#include "schema/base/result.h"

namespace milepost {

enum class Combination { mean, robust };

// Localizes by the tracklets that a frame's features match.
struct TrackletMethod {
  MatchSettings match;
  Combination combination = Combination::robust;
  double min_sigma_m = 0.05;  // of the mean's spread
  RobustSettings robust;      // also finds the start of every method
  IndexSettings index;
  std::variant<PaperTrackerSettings, MotionTrackerSettings> tracker;
};

// What two frames are compared by: the distance of their whole images' descriptors, or the change
// of their matched features' scales.
enum class FrameComparison { image, scale };

// Localizes by dynamic time warping of the frames driven onto the map's frames.
struct WarpMethod {
  FrameComparison comparison = FrameComparison::image;
  ScaleChangeSettings scale;
  double unmatched_cost = 1;  // of frames that cannot be compared
  double max_speed_mps = 50;  // bounds the step from frame to frame ...
  double min_step_m = 5;      // ... and the bound is no less, for frames that come fast
  IndexSettings index;        // over the features of each frame of the map
  double band_m = 10;         // of the map's frames, around where a step may lead
};

// By tracklets: matches, their combination, a tracker.
MakeScout tracklet_scouts(const TrackletMethod& method);

// By whole frames: dynamic time warping.
MakeScout warp_scouts(const WarpMethod& method);

// The names of all methods, the papers' first and the default last.
std::vector<std::string> method_names();

// Errors: invalid_input (no such method; the line lists those that there are).
Result<Method> method_named(const std::string& name);

// The paper's combination: mean (Eq. 4) and spread (Eq. 5) of all estimates, each weighing the
// same. Nothing for no estimate. A floor of `min_sigma_m` keeps a single estimate from being
// certain.
std::optional<Measurement> combine_by_mean(const std::vector<PositionEstimate>& estimates,
                                           double min_sigma_m);

// Combines estimates as the method does.
std::optional<Measurement> combine(const std::vector<PositionEstimate>& estimates,
                                   const TrackletMethod& method);

std::unique_ptr<Tracker> make_tracker(const TrackletMethod& method);

}  // namespace milepost
