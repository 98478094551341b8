// The methods that can be compared, and what each is made of.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "client/localize/estimate.h"
#include "client/localize/matching.h"
#include "client/localize/scale_change.h"
#include "client/localize/tracker.h"
#include "schema/base/result.h"

namespace milepost {

enum class Combination { mean, robust };

// Localizes by the tracklets that a frame's features match.
struct TrackletMethod {
  MatchSettings match;
  Combination combination = Combination::robust;
  double min_sigma_m = 0.05;  // of the mean's spread
  RobustSettings robust;      // also finds the start of every method
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
  double band_m = 10;         // of the map's frames, around where a step may lead
};

struct Method {
  std::string name;
  std::string layer;  // of the map, that it needs
  std::variant<TrackletMethod, WarpMethod> how;
};

inline constexpr const char* kDefaultMethod = "milepost";

// The names of all methods, the papers' first.
std::vector<std::string> method_names();

// Errors: invalid_input (no such method; the line lists those that there are).
Result<Method> method_named(const std::string& name);

// Combines estimates as the method does.
std::optional<Measurement> combine(const std::vector<PositionEstimate>& estimates,
                                   const TrackletMethod& method);

std::unique_ptr<Tracker> make_tracker(const TrackletMethod& method);

}  // namespace milepost
