#include <algorithm>
#include <cmath>
#include <utility>

#include "client/evaluate/baselines/frame_window.h"
#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/baselines/paper_likelihood.h"
#include "client/evaluate/baselines/scale_change.h"
#include "client/evaluate/baselines/warping.h"
#include "client/localize/segment_tracker.h"

namespace milepost {
namespace {

constexpr double kLogBayesFactorOfCost = 20;  // per unit of the first frame's cost

// The comparison of a query frame with the map's frames in a band.
struct Comparison {
  std::vector<FrameCost> costs;  // one per frame of the map, by ascending arc length
  std::vector<int> matches;      // one per frame of the map
  bool compared = false;         // with at least one of them
};

// Statistics of the costs of the best path, frame by frame.
class PathCosts {
 public:
  void add(double cost) {
    sum_ += cost;
    square_ += cost * cost;
    ++frames_;
  }

  // The variance of the costs, with one additional frame that is off by their mean: the variance of
  // few is unknown. REQUIRES: at least one frame.
  double variance() const {
    const double mean = sum_ / frames_;
    return std::max(0.0, square_ - sum_ * mean + mean * mean) / frames_;
  }

 private:
  double sum_ = 0;
  double square_ = 0;
  double frames_ = 0;
};

class WarpTracker : public SegmentTracker {
 public:
  WarpTracker(const std::shared_ptr<const SegmentLayer>& layer, const Camera& camera,
              const WindowReach& reach, const WarpMethod& method)
      : layer_(layer),
        camera_(camera),
        reach_(reach),
        method_(method),
        window_(layer->key, reach, method.index) {}

  const std::shared_ptr<const SegmentLayer>& layer() const override { return layer_; }

  std::unique_ptr<SegmentTracker> continued_on(const std::shared_ptr<const SegmentLayer>& successor,
                                               double begin_m) const override {
    auto continued = std::make_unique<WarpTracker>(successor, camera_, reach_, method_);
    continued->row_ = row_;
    for (WarpCell& cell : continued->row_) cell.along_m -= begin_m;
    continued->path_costs_ = path_costs_;
    continued->latest_s_ = latest_s_;
    continued->likelihood_ = likelihood_;
    continued->likelihood_.pass_junction();
    return continued;
  }

  // The matches at the best position in `around`, and its cost; none if there is no frame to
  // compare with.
  struct Begun {
    int matches = 0;
    double cost = 0;
  };
  std::optional<Begun> begin(SharedFrame& frame, const AlongRange& around) {
    const Comparison seen = compare(frame, around);
    if (!seen.compared) return std::nullopt;
    row_ = first_row(seen.costs);
    const double cost = best_end(row_).cost;
    normalize_costs(frame.timestamp_s());
    return Begun{matches_at_best(seen), cost};
  }

  // Why tiles are missing that the latest frame needs.
  const std::optional<Error>& failure() const { return covered_.failure; }

  TrackedPose pose_at(double /*timestamp_s*/) const override { return pose(); }

  AlongRange needed(double timestamp_s) const override {
    const double latest_m = best_end(row_).along_m;
    return {latest_m - method_.band_m, latest_m + max_step_m(timestamp_s) + method_.band_m};
  }

  TrackingResult track(SharedFrame& frame) override {
    const Comparison seen = compare(frame, needed(frame.timestamp_s()));
    WarpRow next = next_row(row_, seen.costs, max_step_m(frame.timestamp_s()));
    if (!seen.compared || next.empty()) {
      // Tiles that have not arrived are no contradiction.
      const double log_bayes_factor = covered_.complete ? likelihood_.of_frame(false, 0) : 0;
      return {.log_bayes_factor = log_bayes_factor, .failure = covered_.failure};
    }
    row_ = std::move(next);
    normalize_costs(frame.timestamp_s());
    const int matches = matches_at_best(seen);
    return {.measured = true,
            .matches = matches,
            .log_bayes_factor = likelihood_.of_frame(true, matches),
            .failure = covered_.failure};
  }

  // The variance combines the spacing of the map's frames and the spread of the ends of paths that
  // are as good as the best within the variation of its cost from frame to frame.
  TrackedPose pose() const override {
    const WarpCell& best = best_end(row_);
    const double variance = path_costs_.variance();
    double weights = 0;
    double square_m2 = 0;
    for (const WarpCell& cell : row_) {
      const double worse = cell.cost - best.cost;
      const double weight = worse > 0 ? std::exp(-worse * worse / (4 * variance)) : 1;
      weights += weight;
      square_m2 += weight * (cell.along_m - best.along_m) * (cell.along_m - best.along_m);
    }
    return {best.along_m,
            std::hypot(spacing_m() / std::sqrt(12.0), std::sqrt(square_m2 / weights))};
  }

 private:
  double max_step_m(double timestamp_s) const {
    return std::max(method_.max_speed_mps * (timestamp_s - latest_s_), method_.min_step_m);
  }

  Comparison compare(SharedFrame& frame, const AlongRange& band) {
    covered_ = window_.cover(frame.held(), band);
    Comparison comparison;
    for (const IndexedFrame& map_frame : window_.frames()) {
      const double along_m = map_frame.frame().along_m;
      if (!band.contains(along_m)) continue;
      int matches = 0;
      const std::optional<double> cost = cost_of(frame, map_frame, matches);
      comparison.compared = comparison.compared || cost;
      comparison.costs.push_back({along_m, cost.value_or(method_.unmatched_cost)});
      comparison.matches.push_back(matches);
    }
    return comparison;
  }

  std::optional<double> cost_of(SharedFrame& frame, const IndexedFrame& map_frame,
                                int& matches) const {
    if (method_.comparison == FrameComparison::image) {
      if (!frame.frame().image || !map_frame.frame().image) return std::nullopt;
      return image_distance(frame.frame().image(), *map_frame.frame().image);
    }
    const auto change = scale_change(frame.features(layer_->feature()),
                                     layer_->parameters().focal_px() / camera_.pinhole.focal_px(),
                                     camera_.width_px, map_frame, method_.scale);
    if (!change) return std::nullopt;
    matches = change->matches;
    return change->mean;
  }

  // Subtracts the best cost of the new row from the whole row, which changes no comparison and
  // keeps sums small.
  void normalize_costs(double timestamp_s) {
    const double least = best_end(row_).cost;
    for (WarpCell& cell : row_) cell.cost -= least;
    path_costs_.add(least);
    latest_s_ = timestamp_s;
  }

  int matches_at_best(const Comparison& seen) const {
    const auto found = std::ranges::find(seen.costs, best_end(row_).along_m, &FrameCost::along_m);
    return seen.matches[found - seen.costs.begin()];
  }

  double spacing_m() const {
    if (row_.size() < 2) return 0;
    return (row_.back().along_m - row_.front().along_m) / static_cast<double>(row_.size() - 1);
  }

  std::shared_ptr<const SegmentLayer> layer_;
  Camera camera_;
  WindowReach reach_;
  WarpMethod method_;
  FrameWindow window_;
  Covered covered_;  // of the latest band
  WarpRow row_;      // of the latest frame; its least cost is 0
  PathCosts path_costs_;
  double latest_s_ = 0;
  PaperLikelihood likelihood_;
};

class WarpRelocalizer : public Relocalizer {
 public:
  WarpRelocalizer(std::shared_ptr<const SegmentLayer> layer, const Camera& camera,
                  const WindowReach& reach, const WarpMethod& method)
      : layer_(std::move(layer)), camera_(camera), reach_(reach), method_(method) {}

  Relocalization relocalize(SharedFrame& frame, const AlongRange& around,
                            const std::optional<LearnedCamera>& /*camera*/) override {
    auto tracker = std::make_unique<WarpTracker>(layer_, camera_, reach_, method_);
    const auto begun = tracker->begin(frame, around);
    Relocalization found;
    found.failure = tracker->failure();
    if (begun) {
      found.candidates.push_back(
          {std::move(tracker), begun->matches,
           PaperLikelihood::kLogBayesFactor - kLogBayesFactorOfCost * begun->cost});
    }
    return found;
  }

 private:
  std::shared_ptr<const SegmentLayer> layer_;
  Camera camera_;
  WindowReach reach_;
  WarpMethod method_;
};

}  // namespace

MakeRelocalizer warp_relocalizers(const WarpMethod& method) {
  return [method](const std::shared_ptr<const SegmentLayer>& layer, const Camera& camera,
                  const MethodSettings& settings) -> Result<std::unique_ptr<Relocalizer>> {
    if (layer->parameters().items != LayerItems::frames) return unusable_items(*layer);
    return std::unique_ptr<Relocalizer>(
        std::make_unique<WarpRelocalizer>(layer, camera, settings.reach, method));
  };
}

}  // namespace milepost
