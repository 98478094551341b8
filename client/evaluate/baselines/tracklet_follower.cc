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
  TrackletFollower(const SegmentSession& session, const QueryCamera& camera,
                   const ScoutSettings& settings, const TrackletMethod& method)
      : feature_(session.feature),
        scale_ratio_(session.map_focal_px / std::sqrt(camera.focal_x_px * camera.focal_y_px)),
        image_width_px_(camera.width_px),
        min_start_support_(settings.min_start_support),
        on_estimate_(settings.on_estimate),
        method_(method),
        window_(session.layer, session.items, {settings.reach, method.index}),
        tracker_(make_tracker(method)) {}

  // A start is found in two looks: all tracklets in `around`, then those near the answer. The
  // tracklets that agree, or nothing where the frame is no evidence.
  Result<std::optional<int>> begin(SeenFrame& frame, const AlongRange& around) {
    const auto matches = matches_in(frame, around);
    if (!matches) return matches.error();
    const auto seen = combine_robustly(estimates_of(*matches), method_.robust);
    if (!seen || seen->support < min_start_support_) return std::optional<int>();
    const auto near = AlongRange{seen->along_m, seen->along_m}.widened(kStartRefineM);
    const auto again = matches_in(frame, near);
    if (!again) return again.error();
    const Measurement first = combine(estimates_of(*again), method_).value_or(*seen);
    tracker_->start(frame.timestamp_s(), first);
    return std::optional(first.support);
  }

  double expected_along_m(double timestamp_s) const override {
    return tracker_->predict(timestamp_s).along_m;
  }

  Followed follow(SeenFrame& frame) override {
    Followed followed;
    const auto matches = matches_in(frame, tracker_->search_region(frame.timestamp_s()));
    std::optional<Measurement> measured;
    if (matches) {
      tell(*matches);
      measured = combine(estimates_of(*matches), method_);
    } else {
      followed.failure = matches.error();
    }
    followed.measured = tracker_->advance(frame.timestamp_s(), measured);
    followed.matches = followed.measured ? measured->support : 0;
    followed.log_bayes_factor = evidence_.of_frame(followed.measured);
    return followed;
  }

  TrackedPosition position() const override { return tracker_->position(); }

 private:
  Result<std::vector<TrackletMatch>> matches_in(SeenFrame& frame, const AlongRange& region) {
    const Status covered = window_.cover(region);
    if (!covered.ok()) return covered.error();
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
  std::unique_ptr<Tracker> tracker_;
  PaperEvidence evidence_;
};

class TrackletScout : public Scout {
 public:
  TrackletScout(const SegmentSession& session, const QueryCamera& camera, ScoutSettings settings,
                const TrackletMethod& method)
      : session_(session), camera_(camera), settings_(std::move(settings)), method_(method) {}

  Result<std::vector<Sighting>> look(SeenFrame& frame, const AlongRange& around) override {
    auto follower = std::make_unique<TrackletFollower>(session_, camera_, settings_, method_);
    const auto begun = follower->begin(frame, around);
    if (!begun) return begun.error();
    std::vector<Sighting> sightings;
    if (*begun)
      sightings.push_back({std::move(follower), **begun,
                           std::min<double>(**begun, PaperEvidence::kLogBayesFactor)});
    return sightings;
  }

 private:
  const SegmentSession& session_;
  QueryCamera camera_;
  ScoutSettings settings_;
  TrackletMethod method_;
};

}  // namespace

MakeScout tracklet_scouts(const TrackletMethod& method) {
  return [method](const SegmentSession& session, const QueryCamera& camera,
                  const ScoutSettings& settings) -> Result<std::unique_ptr<Scout>> {
    const bool fits =
        session.items == LayerItems::tracklets || session.items == LayerItems::observations;
    if (!fits) return unusable_items(session);
    return std::unique_ptr<Scout>(
        std::make_unique<TrackletScout>(session, camera, settings, method));
  };
}

}  // namespace milepost
