#include "client/evaluate/baselines/methods.h"

#include <algorithm>
#include <cmath>

#include "client/localize/landmark_method.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {
namespace {

// Regression on scale and the mean of all estimates, without and with a filter: the tracklet
// paper's proposed methods 1 and 2 (section 5.2), and the particle filter of section 5.4.
TrackletMethod paper_method(PaperFilter filter) {
  TrackletMethod method;
  method.match.region_margin_m = 0;
  method.combination = Combination::mean;
  method.tracker = PaperTrackerSettings{.filter = filter};
  return method;
}

// tracklet-regression with the descriptors of all observations instead of their mean, to measure
// the cost of averaging. For the laboratory.
TrackletMethod unaveraged_method() {
  TrackletMethod method = paper_method(PaperFilter::none);
  method.match.neighbours = 40;  // a tracklet has as many descriptors as observations
  return method;
}

// Comparative method 3: the closest frame of the map for each feature, without regression.
TrackletMethod matching_method() {
  TrackletMethod method = unaveraged_method();
  method.match.estimation = Estimation::closest_observation;
  return method;
}

// Comparative methods 1 and 2.
WarpMethod warp_method(FrameComparison comparison) {
  WarpMethod method;
  method.comparison = comparison;
  return method;
}

// Our previous method: regression on -1/scale.
TrackletMethod inverse_scale_method() {
  TrackletMethod method;
  method.match.max_distance_ratio = 0.85;
  method.match.same_place_m = 2.0;
  method.match.scale_range_margin = 0.3;
  method.robust.cutoff = 2.5;
  method.tracker = MotionTrackerSettings{};
  return method;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> all = {
      {"wisurf", layers::kWholeImages, warp_relocalizers(warp_method(FrameComparison::image))},
      {"scale-only", layers::kFrames, warp_relocalizers(warp_method(FrameComparison::scale))},
      {"tracklet-matching", layers::kObservations, tracklet_relocalizers(matching_method())},
      {"tracklet-regression", layers::kTrackletsByScale,
       tracklet_relocalizers(paper_method(PaperFilter::none))},
      {"tracklet-regression-kalman", layers::kTrackletsByScale,
       tracklet_relocalizers(paper_method(PaperFilter::kalman))},
      {"tracklet-regression-particle", layers::kTrackletsByScale,
       tracklet_relocalizers(paper_method(PaperFilter::particle))},
      {"tracklet-regression-unaveraged", layers::kObservations,
       tracklet_relocalizers(unaveraged_method())},
      {"inverse-scale", layers::kTrackletsByInverseScale,
       tracklet_relocalizers(inverse_scale_method())},
      landmark_method(),
  };
  return all;
}

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Method& method : methods()) names.push_back(method.name);
  return names;
}

Result<Method> method_named(const std::string& name) {
  std::string known;
  for (const Method& method : methods()) {
    if (method.name == name) return method;
    known += (known.empty() ? "" : ", ") + method.name;
  }
  return Error{ErrorCode::invalid_input, "--method", "'" + name + "' is not a method",
               "choose from " + known};
}

std::optional<Measurement> combine_by_mean(const std::vector<PositionEstimate>& estimates,
                                           double min_sigma_m) {
  if (estimates.empty()) return std::nullopt;
  const auto count = static_cast<double>(estimates.size());
  double mean_m = 0;  // Eq. 4
  for (const PositionEstimate& estimate : estimates) mean_m += estimate.along_m / count;
  double variance = 0;  // Eq. 5
  for (const PositionEstimate& estimate : estimates) {
    variance += (estimate.along_m - mean_m) * (estimate.along_m - mean_m) / count;
  }
  return Measurement{mean_m, std::max(std::sqrt(variance), min_sigma_m),
                     static_cast<int>(estimates.size())};
}

std::optional<Measurement> combine(const std::vector<PositionEstimate>& estimates,
                                   const TrackletMethod& method) {
  return method.combination == Combination::mean ? combine_by_mean(estimates, method.min_sigma_m)
                                                 : combine_robustly(estimates, method.robust);
}

std::unique_ptr<ArcLengthTracker> make_tracker(const TrackletMethod& method) {
  if (const auto* paper = std::get_if<PaperTrackerSettings>(&method.tracker)) {
    return make_paper_tracker(*paper);
  }
  return make_motion_tracker(std::get<MotionTrackerSettings>(method.tracker));
}

}  // namespace milepost
