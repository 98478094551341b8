#include <algorithm>
#include <cmath>

#include "client/localize/landmark_tracker.h"
#include "client/localize/pose_consensus.h"

namespace milepost {
namespace {

class LandmarkRelocalizer : public Relocalizer {
 public:
  LandmarkRelocalizer(std::shared_ptr<const SegmentLayer> layer, const Camera& camera,
                      const MethodSettings& settings, const LandmarkMethod& method)
      : search_(std::make_shared<const LandmarkSearch>(LandmarkSearch{
            camera, method, settings.min_start_support, settings.reach, settings.on_estimate})),
        layer_(std::move(layer)),
        window_(settings.reach, layer_->line.point_at(0)) {}

  Relocalization relocalize(SharedFrame& frame, const AlongRange& around,
                            const std::optional<LearnedCamera>& camera) override {
    const RouteLine& line = layer_->line;
    Relocalization found;
    const auto road = road_around(frame.held(), layer_, around, search_->reach);
    found.failure = window_.cover(frame.held(), road, around).failure;
    recenter_frame(line.point_at(std::clamp(around.middle_m(), 0.0, line.length_m())));
    for (const double along_m : densest_along_m(compact_frame(frame, *layer_), around)) {
      auto tracker = std::make_unique<LandmarkTracker>(search_, layer_, window_);
      const TrackingResult begun = tracker->begin(frame, along_m, camera);
      if (begun.failure && !found.failure) found.failure = begun.failure;
      if (!begun.measured) continue;
      found.candidates.push_back({std::move(tracker), begun.matches, begun.log_bayes_factor});
    }
    std::ranges::stable_sort(found.candidates, std::greater<>(),
                             &RelocalizationCandidate::log_bayes_factor);
    return found;
  }

 private:
  void recenter_frame(const GeoPoint& place) {
    constexpr double kMaxDistanceM = 100;
    const EnuPoint off = window_.frame().enu_from_geo(place);
    if (std::hypot(off.east_m, off.north_m) > kMaxDistanceM) window_.set_origin(place);
  }

  // Candidate arc lengths from the scales of the global matches: the densest votes, apart from each
  // other.
  std::vector<double> densest_along_m(const CompactFrame& frame, const AlongRange& around) const {
    const LandmarkMethod& method = search_->method;
    const auto matches = match_global(frame, layer_->parameters().projection->quantization_step(),
                                      window_.landmarks(), around, method.match);
    std::vector<PositionEstimate> left =
        along_by_scale(matches, frame.features, window_.landmarks(), search_->camera.pinhole,
                       method.solver.scale_sigma);
    std::vector<double> places;
    while (static_cast<int>(places.size()) < method.max_start_places) {
      const auto densest = combine_robustly(left, method.vote);
      if (!densest || densest->support < search_->min_start_support) break;
      places.push_back(densest->along_m);
      std::erase_if(left, [&](const PositionEstimate& estimate) {
        return std::abs(estimate.along_m - densest->along_m) < method.start_places_apart_m;
      });
    }
    return places;
  }

  std::shared_ptr<const LandmarkSearch> search_;
  std::shared_ptr<const SegmentLayer> layer_;
  LandmarkWindow window_;
};

}  // namespace

Method landmark_method(const LandmarkMethod& settings) {
  const auto make_relocalizer =
      [settings](const std::shared_ptr<const SegmentLayer>& layer, const Camera& camera,
                 const MethodSettings& given) -> Result<std::unique_ptr<Relocalizer>> {
    if (layer->parameters().items != LayerItems::landmarks) return unusable_items(*layer);
    return std::unique_ptr<Relocalizer>(
        std::make_unique<LandmarkRelocalizer>(layer, camera, given, settings));
  };
  return {kDefaultMethod, layers::kLandmarks, make_relocalizer, true};
}

}  // namespace milepost
