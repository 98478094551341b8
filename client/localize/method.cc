#include "client/localize/method.h"

namespace milepost {
namespace {

// The tracklet paper's proposed methods 1 and 2 (section 5.2): regression on scale, the mean of all
// estimates, without and with a filter.
Method paper_method(const std::string& name, PaperFilter filter) {
  Method method;
  method.name = name;
  method.layer = "tracklets-scale";
  method.match.region_margin_m = 0;
  method.combination = Combination::mean;
  method.tracker = PaperTrackerSettings{.filter = filter};
  return method;
}

// The regression of tracklet-regression with the descriptors of all observations in place of their
// mean: what averaging costs. For the laboratory.
Method unaveraged_method(const std::string& name) {
  Method method = paper_method(name, PaperFilter::none);
  method.layer = "observations";
  method.match.neighbours = 40;  // a tracklet has as many descriptors as observations
  return method;
}

// The paper's comparative method 3: the closest frame of the map for each feature, no regression.
Method matching_method(const std::string& name) {
  Method method = unaveraged_method(name);
  method.match.estimation = Estimation::closest_observation;
  return method;
}

Method milepost_method() {
  Method method;
  method.name = kDefaultMethod;
  method.layer = "tracklets";
  method.match.max_distance_ratio = 0.85;
  method.match.same_place_m = 2.0;
  method.match.scale_range_margin = 0.3;
  method.robust.cutoff = 2.5;
  method.tracker = MotionTrackerSettings{};
  return method;
}

}  // namespace

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = {"tracklet-matching",
                                                 "tracklet-regression",
                                                 "tracklet-regression-kalman",
                                                 "tracklet-regression-particle",
                                                 "tracklet-regression-unaveraged",
                                                 kDefaultMethod};
  return names;
}

Result<Method> method_named(const std::string& name) {
  if (name == "tracklet-matching") return matching_method(name);
  if (name == "tracklet-regression") return paper_method(name, PaperFilter::none);
  if (name == "tracklet-regression-kalman") return paper_method(name, PaperFilter::kalman);
  if (name == "tracklet-regression-particle") return paper_method(name, PaperFilter::particle);
  if (name == "tracklet-regression-unaveraged") return unaveraged_method(name);
  if (name == kDefaultMethod) return milepost_method();
  std::string known;
  for (const std::string& each : method_names()) known += (known.empty() ? "" : ", ") + each;
  return Error{ErrorCode::invalid_input, "--method", "'" + name + "' is no method",
               "choose from " + known};
}

std::optional<Measurement> combine(const std::vector<PositionEstimate>& estimates,
                                   const Method& method) {
  return method.combination == Combination::mean ? combine_by_mean(estimates, method.min_sigma_m)
                                                 : combine_robustly(estimates, method.robust);
}

std::unique_ptr<Tracker> make_tracker(const Method& method) {
  if (const auto* paper = std::get_if<PaperTrackerSettings>(&method.tracker)) {
    return make_paper_tracker(*paper);
  }
  return make_motion_tracker(std::get<MotionTrackerSettings>(method.tracker));
}

}  // namespace milepost
