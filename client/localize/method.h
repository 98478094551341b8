// The methods that can be compared, and what each is made of.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "client/localize/estimate.h"
#include "client/localize/matching.h"
#include "client/localize/tracker.h"
#include "schema/base/result.h"

namespace milepost {

enum class Combination { mean, robust };

struct Method {
  std::string name;
  std::string layer;  // of tracklets that it matches against
  MatchSettings match;
  Combination combination = Combination::robust;
  double min_sigma_m = 0.05;  // of the mean's spread
  RobustSettings robust;      // also finds the start of every method
  std::variant<PaperTrackerSettings, MotionTrackerSettings> tracker;
};

inline constexpr const char* kDefaultMethod = "milepost";

// The names of all methods, the papers' first.
const std::vector<std::string>& method_names();

// Errors: invalid_input (no such method; the line lists those that there are).
Result<Method> method_named(const std::string& name);

// Combines estimates as the method does.
std::optional<Measurement> combine(const std::vector<PositionEstimate>& estimates,
                                   const Method& method);

std::unique_ptr<Tracker> make_tracker(const Method& method);

}  // namespace milepost
