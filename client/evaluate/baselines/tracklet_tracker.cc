#include <algorithm>
#include <cmath>

#include "client/evaluate/baselines/matching.h"
#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/baselines/paper_likelihood.h"
#include "client/evaluate/baselines/tracklet_window.h"
#include "client/localize/segment_tracker.h"

namespace milepost {
namespace {

constexpr double kStartRefineM = 3;  // half width around the start, for the second pass

class TrackletTracker : public SegmentTracker {
 public:
  TrackletTracker(const SegmentLayer& layer, const Camera& camera, const MethodSettings& settings,
                  const TrackletMethod& method)
      : feature_(layer.feature()),
        scale_ratio_(layer.parameters().focal_px() / camera.pinhole.focal_px()),
        image_width_px_(camera.width_px),
        min_start_support_(settings.min_start_support),
        on_estimate_(settings.on_estimate),
        method_(method),
        window_(layer.key, {settings.reach, method.index}),
        tracker_(make_tracker(method)) {}

  // Finds a start in two passes: with all tracklets in `around`, then with those near the result.
  // Returns the number of inlier tracklets; none without enough support.
  std::optional<int> begin(SharedFrame& frame, const AlongRange& around) {
    const auto matches = matches_in(frame, around);
    const auto found = combine_robustly(estimates_of(matches), method_.robust);
    if (!found || found->support < min_start_support_) return std::nullopt;
    const auto near = AlongRange{found->along_m, found->along_m}.widened(kStartRefineM);
    const auto again = matches_in(frame, near);
    const Measurement first = combine(estimates_of(again), method_).value_or(*found);
    tracker_->start(frame.timestamp_s(), first);
    return first.support;
  }

  // Why tiles are missing that the latest frame needs.
  const std::optional<Error>& failure() const { return covered_.failure; }

  AlongRange needed(double timestamp_s) const override {
    return tracker_->search_region(timestamp_s);
  }

  TrackedPose pose_at(double timestamp_s) const override { return tracker_->predict(timestamp_s); }

  TrackingResult track(SharedFrame& frame) override {
    TrackingResult result;
    const auto matches = matches_in(frame, tracker_->search_region(frame.timestamp_s()));
    report_estimates(matches);
    const auto measured = combine(estimates_of(matches), method_);
    result.failure = covered_.failure;
    result.measured = tracker_->advance(frame.timestamp_s(), measured);
    result.matches = result.measured ? measured->support : 0;
    result.log_bayes_factor = likelihood_.of_frame(result.measured);
    return result;
  }

  TrackedPose pose() const override { return tracker_->pose(); }

 private:
  std::vector<TrackletMatch> matches_in(SharedFrame& frame, const AlongRange& region) {
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

  void report_estimates(const std::vector<TrackletMatch>& matches) const {
    if (!on_estimate_) return;
    for (const TrackletMatch& match : matches) {
      const Tracklet& tracklet = window_.tracklets()[match.tracklet];
      on_estimate_({match.estimate, match.scale_px, tracklet.along, tracklet.r_squared});
    }
  }

  FeatureParameters feature_;
  double scale_ratio_;  // converts scales of the query camera to those of the map's
  int image_width_px_;
  int min_start_support_;
  std::function<void(const TrackletEstimate&)> on_estimate_;
  TrackletMethod method_;
  TrackletWindow window_;
  Covered covered_;  // of the latest region
  std::unique_ptr<ArcLengthTracker> tracker_;
  PaperLikelihood likelihood_;
};

class TrackletRelocalizer : public Relocalizer {
 public:
  TrackletRelocalizer(const SegmentLayer& layer, const Camera& camera, MethodSettings settings,
                      const TrackletMethod& method)
      : layer_(layer), camera_(camera), settings_(std::move(settings)), method_(method) {}

  Relocalization relocalize(SharedFrame& frame, const AlongRange& around,
                            const std::optional<LearnedCamera>& /*camera*/) override {
    auto tracker = std::make_unique<TrackletTracker>(layer_, camera_, settings_, method_);
    const std::optional<int> begun = tracker->begin(frame, around);
    Relocalization found;
    found.failure = tracker->failure();
    if (begun) {
      found.candidates.push_back(
          {std::move(tracker), *begun, std::min<double>(*begun, PaperLikelihood::kLogBayesFactor)});
    }
    return found;
  }

 private:
  const SegmentLayer& layer_;
  Camera camera_;
  MethodSettings settings_;
  TrackletMethod method_;
};

}  // namespace

MakeRelocalizer tracklet_relocalizers(const TrackletMethod& method) {
  return [method](const SegmentLayer& layer, const Camera& camera,
                  const MethodSettings& settings) -> Result<std::unique_ptr<Relocalizer>> {
    const LayerItems items = layer.parameters().items;
    if (items != LayerItems::tracklets && items != LayerItems::observations) {
      return unusable_items(layer);
    }
    return std::unique_ptr<Relocalizer>(
        std::make_unique<TrackletRelocalizer>(layer, camera, settings, method));
  };
}

}  // namespace milepost
