#include <algorithm>
#include <cmath>

#include "client/evaluate/baselines/matching.h"
#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/baselines/paper_evidence.h"
#include "client/evaluate/baselines/tracklet_window.h"
#include "client/localize/follower.h"

namespace milepost {
namespace {

constexpr double kStartRefineM = 3;  // to either side of the start, for the second look

class TrackletFollower : public Follower {
 public:
  TrackletFollower(const SegmentLayer& layer, const Camera& camera, const ScoutSettings& settings,
                   const TrackletMethod& method)
      : feature_(layer.feature()),
        scale_ratio_(layer.parameters().focal_px() / camera.pinhole.focal_px()),
        image_width_px_(camera.width_px),
        min_start_support_(settings.min_start_support),
        on_estimate_(settings.on_estimate),
        method_(method),
        window_(layer.key, {settings.reach, method.index}),
        tracker_(make_tracker(method)) {}

  // A start is found in two looks: all tracklets in `around`, then those near the answer. The
  // tracklets that agree, or nothing where the frame is no evidence.
  std::optional<int> begin(SeenFrame& frame, const AlongRange& around) {
    const auto matches = matches_in(frame, around);
    const auto seen = combine_robustly(estimates_of(matches), method_.robust);
    if (!seen || seen->support < min_start_support_) return std::nullopt;
    const auto near = AlongRange{seen->along_m, seen->along_m}.widened(kStartRefineM);
    const auto again = matches_in(frame, near);
    const Measurement first = combine(estimates_of(again), method_).value_or(*seen);
    tracker_->start(frame.timestamp_s(), first);
    return first.support;
  }

  // Why tiles are missing that the latest frame would have been compared with.
  const std::optional<Error>& failure() const { return covered_.failure; }

  AlongRange needed(double timestamp_s) const override {
    return tracker_->search_region(timestamp_s);
  }

  TrackedPosition position_at(double timestamp_s) const override {
    return tracker_->predict(timestamp_s);
  }

  Followed follow(SeenFrame& frame) override {
    Followed followed;
    const auto matches = matches_in(frame, tracker_->search_region(frame.timestamp_s()));
    tell(matches);
    const auto measured = combine(estimates_of(matches), method_);
    followed.failure = covered_.failure;
    followed.measured = tracker_->advance(frame.timestamp_s(), measured);
    followed.matches = followed.measured ? measured->support : 0;
    followed.log_bayes_factor = evidence_.of_frame(followed.measured);
    return followed;
  }

  TrackedPosition position() const override { return tracker_->position(); }

 private:
  std::vector<TrackletMatch> matches_in(SeenFrame& frame, const AlongRange& region) {
    covered_ = window_.cover(frame.held(), region);
    return match_tracklets(frame.features(feature_), scale_ratio_, image_width_px_, window_, region,
                           method_.match);
  }

  static std::vector<PositionEstimate> estimates_of(const std::vector<TrackletMatch>& matches) {
    std::vector<PositionEstimate> estimates;
    estimates.reserve(matches.size());
    for (const TrackletMatch& match : matches) estimates.push_back(match.estimate);
    return estimates;
  }

  void tell(const std::vector<TrackletMatch>& matches) const {
    if (!on_estimate_) return;
    for (const TrackletMatch& match : matches) {
      const Tracklet& tracklet = window_.tracklets()[match.tracklet];
      on_estimate_({match.estimate, match.scale_px, tracklet.along, tracklet.r_squared});
    }
  }

  FeatureParameters feature_;
  double scale_ratio_;  // brings scales of the query's camera to those of the map's
  int image_width_px_;
  int min_start_support_;
  std::function<void(const TrackletEstimate&)> on_estimate_;
  TrackletMethod method_;
  TrackletWindow window_;
  Covered covered_;  // of the latest region
  std::unique_ptr<Tracker> tracker_;
  PaperEvidence evidence_;
};

class TrackletScout : public Scout {
 public:
  TrackletScout(const SegmentLayer& layer, const Camera& camera, ScoutSettings settings,
                const TrackletMethod& method)
      : layer_(layer), camera_(camera), settings_(std::move(settings)), method_(method) {}

  Looked look(SeenFrame& frame, const AlongRange& around,
              const std::optional<LearnedCamera>& /*camera*/) override {
    auto follower = std::make_unique<TrackletFollower>(layer_, camera_, settings_, method_);
    const std::optional<int> begun = follower->begin(frame, around);
    Looked looked;
    looked.failure = follower->failure();
    if (begun) {
      looked.sightings.push_back(
          {std::move(follower), *begun, std::min<double>(*begun, PaperEvidence::kLogBayesFactor)});
    }
    return looked;
  }

 private:
  const SegmentLayer& layer_;
  Camera camera_;
  ScoutSettings settings_;
  TrackletMethod method_;
};

}  // namespace

MakeScout tracklet_scouts(const TrackletMethod& method) {
  return [method](const SegmentLayer& layer, const Camera& camera,
                  const ScoutSettings& settings) -> Result<std::unique_ptr<Scout>> {
    const LayerItems items = layer.parameters().items;
    if (items != LayerItems::tracklets && items != LayerItems::observations) {
      return unusable_items(layer);
    }
    return std::unique_ptr<Scout>(std::make_unique<TrackletScout>(layer, camera, settings, method));
  };
}

}  // namespace milepost
