#include <algorithm>
#include <cmath>

#include "client/localize/landmark_follower.h"
#include "client/localize/pose_consensus.h"

namespace milepost {
namespace {

class LandmarkScout : public Scout {
 public:
  LandmarkScout(const SegmentLayer& layer, const Camera& camera, const ScoutSettings& settings,
                const LandmarkMethod& method)
      : search_{&layer, camera, method, settings.min_start_support, settings.on_estimate},
        window_(layer.key, settings.reach, layer.line) {}

  Looked look(SeenFrame& frame, const AlongRange& around,
              const std::optional<LearnedCamera>& camera) override {
    const RouteLine& line = search_.layer->line;
    Looked looked;
    looked.failure = window_.cover(frame.held(), around).failure;
    lay_origin_near(line.point_at(std::clamp(around.middle_m(), 0.0, line.length_m())));
    for (const double along_m : densest_along_m(search_.compact(frame), around)) {
      auto follower = std::make_unique<LandmarkFollower>(search_, window_);
      const Followed begun = follower->begin(frame, along_m, camera);
      if (begun.failure && !looked.failure) looked.failure = begun.failure;
      if (!begun.measured) continue;
      looked.sightings.push_back({std::move(follower), begun.matches, begun.log_bayes_factor});
    }
    std::ranges::stable_sort(looked.sightings, std::greater<>(), &Sighting::log_bayes_factor);
    return looked;
  }

 private:
  void lay_origin_near(const GeoPoint& place) {
    constexpr double kMaxDistanceM = 100;
    const EnuPoint off = window_.frame().enu_from_geo(place);
    if (std::hypot(off.east_m, off.north_m) > kMaxDistanceM) window_.set_origin(place);
  }

  // Where the scales of what looks alike put the camera: the densest places, apart from each other.
  std::vector<double> densest_along_m(const CompactFrame& frame, const AlongRange& around) const {
    const LandmarkMethod& method = search_.method;
    const auto matches = match_anywhere(frame, search_.layer->parameters().codebook->step(),
                                        window_.landmarks(), around, method.match);
    std::vector<PositionEstimate> left =
        along_by_scale(matches, frame.features, window_.landmarks(), search_.camera.pinhole,
                       search_.layer->line, window_.frame(), method.solver.scale_sigma);
    std::vector<double> places;
    while (static_cast<int>(places.size()) < method.max_start_places) {
      const auto densest = combine_robustly(left, method.vote);
      if (!densest || densest->support < search_.min_start_support) break;
      places.push_back(densest->along_m);
      std::erase_if(left, [&](const PositionEstimate& estimate) {
        return std::abs(estimate.along_m - densest->along_m) < method.start_places_apart_m;
      });
    }
    return places;
  }

  LandmarkSearch search_;
  LandmarkWindow window_;
};

}  // namespace

Method landmark_method(const LandmarkMethod& settings) {
  const auto make_scout = [settings](const SegmentLayer& layer, const Camera& camera,
                                     const ScoutSettings& scout) -> Result<std::unique_ptr<Scout>> {
    if (layer.parameters().items != LayerItems::landmarks) return unusable_items(layer);
    return std::unique_ptr<Scout>(std::make_unique<LandmarkScout>(layer, camera, scout, settings));
  };
  return {kDefaultMethod, layers::kLandmarks, make_scout, true};
}

}  // namespace milepost
