#include <algorithm>
#include <cmath>
#include <utility>

#include "client/evaluate/baselines/matching.h"
#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/baselines/paper_likelihood.h"
#include "client/evaluate/baselines/tracklet_window.h"
#include "client/localize/segment_tracker.h"

namespace milepost {
namespace {

constexpr double kStartRefineM = 3;  // half width around the start, for the second pass
constexpr int kByChance = 12;        // inliers of a start in a wrong place

class TrackletTracker : public SegmentTracker {
 public:
  TrackletTracker(const std::shared_ptr<const SegmentLayer>& layer, const Camera& camera,
                  const MethodSettings& settings, const TrackletMethod& method)
      : layer_(layer),
        camera_(camera),
        settings_(settings),
        method_(method),
        window_(layer->key, {settings.reach, method.index}),
        tracker_(make_tracker(method)) {}

  const std::shared_ptr<const SegmentLayer>& layer() const override { return layer_; }

  std::unique_ptr<SegmentTracker> continued_on(const std::shared_ptr<const SegmentLayer>& successor,
                                               double begin_m) const override {
    auto continued = std::make_unique<TrackletTracker>(successor, camera_, settings_, method_);
    continued->begin_m_ = begin_m_ + begin_m;
    continued->tracker_ = tracker_->clone();
    continued->likelihood_ = likelihood_;
    continued->likelihood_.pass_junction();
    return continued;
  }

  // Finds a start in two passes: with all tracklets in `around`, then with those near the result.
  // Returns the number of inlier tracklets; none without enough support.
  std::optional<int> begin(SharedFrame& frame, const AlongRange& around) {
    const auto matches = matches_in(frame, around);
    const auto found = combine_robustly(estimates_of(matches), method_.robust);
    if (!found || found->support < settings_.min_start_support) return std::nullopt;
    const auto near = AlongRange{found->along_m, found->along_m}.widened(kStartRefineM);
    const auto again = matches_in(frame, near);
    const Measurement first = combine(estimates_of(again), method_).value_or(*found);
    tracker_->start(frame.timestamp_s(), first);
    return first.support;
  }

  // Why tiles are missing that the latest frame needs.
  const std::optional<Error>& failure() const { return covered_.failure; }

  AlongRange needed(double timestamp_s) const override {
    return tracker_->search_region(timestamp_s).shifted(-begin_m_);
  }

  TrackedPose pose_at(double timestamp_s) const override {
    return on_segment(tracker_->predict(timestamp_s));
  }

  TrackingResult track(SharedFrame& frame) override {
    TrackingResult result;
    const auto matches = matches_in(frame, needed(frame.timestamp_s()));
    report_estimates(matches);
    auto measured = combine(estimates_of(matches), method_);
    if (measured) measured->along_m += begin_m_;
    result.failure = covered_.failure;
    result.measured = tracker_->advance(frame.timestamp_s(), measured);
    result.matches = result.measured ? measured->support : 0;
    // Tiles that have not arrived are no contradiction.
    if (result.measured || covered_.complete)
      result.log_bayes_factor = likelihood_.of_frame(result.measured, result.matches);
    return result;
  }

  TrackedPose pose() const override { return on_segment(tracker_->pose()); }

 private:
  TrackedPose on_segment(TrackedPose pose) const {
    pose.along_m -= begin_m_;
    return pose;
  }

  std::vector<TrackletMatch> matches_in(SharedFrame& frame, const AlongRange& region) {
    covered_ = window_.cover(frame.held(), region);
    // Converts scales of the query camera to those of the map's.
    const double scale_ratio = layer_->parameters().focal_px() / camera_.pinhole.focal_px();
    return match_tracklets(frame.features(layer_->feature()), scale_ratio, camera_.width_px,
                           window_, region, method_.match);
  }

  static std::vector<PositionEstimate> estimates_of(const std::vector<TrackletMatch>& matches) {
    std::vector<PositionEstimate> estimates;
    estimates.reserve(matches.size());
    for (const TrackletMatch& match : matches) estimates.push_back(match.estimate);
    return estimates;
  }

  void report_estimates(const std::vector<TrackletMatch>& matches) const {
    if (!settings_.on_estimate) return;
    for (const TrackletMatch& match : matches) {
      const Tracklet& tracklet = window_.tracklets()[match.tracklet];
      settings_.on_estimate({match.estimate, match.scale_px, tracklet.along, tracklet.r_squared});
    }
  }

  std::shared_ptr<const SegmentLayer> layer_;
  Camera camera_;
  MethodSettings settings_;
  TrackletMethod method_;
  TrackletWindow window_;
  Covered covered_;  // of the latest region
  std::unique_ptr<ArcLengthTracker> tracker_;
  double begin_m_ = 0;  // of the segment, in the tracker's arc length: where its way began is 0
  PaperLikelihood likelihood_;
};

class TrackletRelocalizer : public Relocalizer {
 public:
  TrackletRelocalizer(std::shared_ptr<const SegmentLayer> layer, const Camera& camera,
                      MethodSettings settings, const TrackletMethod& method)
      : layer_(std::move(layer)),
        camera_(camera),
        settings_(std::move(settings)),
        method_(method) {}

  Relocalization relocalize(SharedFrame& frame, const AlongRange& around,
                            const std::optional<LearnedCamera>& /*camera*/) override {
    auto tracker = std::make_unique<TrackletTracker>(layer_, camera_, settings_, method_);
    const std::optional<int> begun = tracker->begin(frame, around);
    Relocalization found;
    found.failure = tracker->failure();
    if (begun) {
      found.candidates.push_back(
          {std::move(tracker), *begun,
           std::min<double>(*begun - kByChance, PaperLikelihood::kLogBayesFactor)});
    }
    return found;
  }

 private:
  std::shared_ptr<const SegmentLayer> layer_;
  Camera camera_;
  MethodSettings settings_;
  TrackletMethod method_;
};

}  // namespace

MakeRelocalizer tracklet_relocalizers(const TrackletMethod& method) {
  return [method](const std::shared_ptr<const SegmentLayer>& layer, const Camera& camera,
                  const MethodSettings& settings) -> Result<std::unique_ptr<Relocalizer>> {
    const LayerItems items = layer->parameters().items;
    if (items != LayerItems::tracklets && items != LayerItems::observations) {
      return unusable_items(*layer);
    }
    return std::unique_ptr<Relocalizer>(
        std::make_unique<TrackletRelocalizer>(layer, camera, settings, method));
  };
}

}  // namespace milepost
