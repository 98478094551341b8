#include "mapper/import/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <opencv2/imgcodecs.hpp>

#include "mapper/findings/image_motion.h"
#include "schema/base/digits.h"
#include "schema/base/file.h"
#include "schema/base/median.h"
#include "schema/drive/image_decode.h"

namespace milepost {
namespace {

constexpr std::size_t kMaxImages = 3000;

// What moved between two consecutive images.
struct SeenStep {
  double from_s = 0;
  double to_s = 0;
  MovedImage moved;
};

Result<std::vector<SeenStep>> seen_steps(const std::vector<RecordedImage>& images,
                                         const Camera& camera) {
  ImageMotion motion(camera);
  std::vector<SeenStep> steps;
  for (std::size_t i = 0; i < std::min(images.size(), kMaxImages); ++i) {
    Result<std::string> bytes = read_text_file(images[i].file);
    if (!bytes) return bytes.error();
    const auto gray = decoded_image(std::move(*bytes), cv::IMREAD_GRAYSCALE);
    if (!gray) {
      return Error{gray.error().code, images[i].file.string(), gray.error().what,
                   gray.error().hint};
    }
    if (const auto moved = motion.to(*gray))
      steps.push_back({images[i - 1].timestamp_s, images[i].timestamp_s, *moved});
  }
  return steps;
}

// What the trajectory does during the steps, moved by an offset: nothing if it does not know most
// of them.
enum class Signal { turns, speeds };

class Comparison {
 public:
  Comparison(const std::vector<SeenStep>& steps, const Trajectory& trajectory, Signal signal)
      : steps_(steps), trajectory_(trajectory), signal_(signal) {}

  double correlation_at(double offset_s) const {
    std::vector<double> seen;
    std::vector<double> driven;
    for (const SeenStep& step : steps_) {
      const auto from = trajectory_.at(step.from_s + offset_s);
      const auto to = trajectory_.at(step.to_s + offset_s);
      if (!from || !to) continue;
      if (signal_ == Signal::turns) {
        seen.push_back(step.moved.turn_deg);
        driven.push_back(turn_deg(from->heading_deg, to->heading_deg));
      } else {
        seen.push_back(step.moved.change);
        driven.push_back(geodesic_distance_m(from->position, to->position) /
                         (step.to_s - step.from_s));
      }
    }
    constexpr double kLeastShare = 0.6;
    if (static_cast<double>(seen.size()) < kLeastShare * static_cast<double>(steps_.size()))
      return 0;
    if (signal_ == Signal::speeds) {
      subtract_mean(seen);
      subtract_mean(driven);
    }
    return correlation(seen, driven);
  }

 private:
  static void subtract_mean(std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    for (double& value : values) value -= sum / static_cast<double>(values.size());
  }

  const std::vector<SeenStep>& steps_;
  const Trajectory& trajectory_;
  Signal signal_;
};

// Whether the trajectory turns at all.
bool has_turns(const Trajectory& trajectory) {
  constexpr double kLeastDeg = 10;
  double turned_deg = 0;
  const std::vector<RecordedPose>& poses = trajectory.poses();
  for (std::size_t i = 0; i + 1 < poses.size(); ++i)
    turned_deg +=
        std::abs(turn_deg(poses[i].attitude.heading_deg, poses[i + 1].attitude.heading_deg));
  return turned_deg >= kLeastDeg;
}

}  // namespace

Result<ClockOffset> estimate_clock_offset(const std::vector<RecordedImage>& images,
                                          const Trajectory& positions, const Trajectory& headings,
                                          const Camera& camera, double range_s) {
  constexpr std::size_t kFewest = 30;
  constexpr double kAgrees = 0.7;
  constexpr double kBetter = 0.75;  // of what another place leaves unexplained
  const auto steps = seen_steps(images, camera);
  if (!steps) return steps.error();
  const auto unknown = [](const std::string& what) {
    return Error{ErrorCode::invalid_input, "--estimate-offset-s", what,
                 "give the offset with --time-offset-s"};
  };
  if (steps->size() < kFewest)
    return unknown("needs " + std::to_string(kFewest) + " images and more");
  std::vector<double> intervals_s;
  intervals_s.reserve(steps->size());
  for (const SeenStep& step : *steps) intervals_s.push_back(step.to_s - step.from_s);
  const double interval_s = median_of(intervals_s);
  if (!(interval_s > 0)) return unknown("needs images with times of their own");

  const Signal signal = has_turns(headings) ? Signal::turns : Signal::speeds;
  const Comparison comparison(*steps, signal == Signal::turns ? headings : positions, signal);
  struct Tried {
    double offset_s = 0;
    double correlation = 0;
  };
  std::vector<Tried> tried;
  const double step_s = interval_s / 2;
  const auto count = static_cast<long>(std::ceil(range_s / step_s));
  for (long i = -count; i <= count; ++i) {
    const double offset_s = static_cast<double>(i) * step_s;
    tried.push_back({offset_s, comparison.correlation_at(offset_s)});
  }
  Tried best = *std::ranges::max_element(tried, {}, &Tried::correlation);
  const double apart_s = std::max(2.0, 4 * interval_s);
  double other = 0;
  for (const Tried& each : tried) {
    if (std::abs(each.offset_s - best.offset_s) > apart_s)
      other = std::max(other, each.correlation);
  }
  const auto unexplained = [](double r) { return 1 - r * r; };
  if (best.correlation < kAgrees || unexplained(best.correlation) > kBetter * unexplained(other)) {
    return unknown("finds none: what is seen goes with what was driven by " +
                   fixed(best.correlation, 2) + " at " + fixed(best.offset_s, 2) + " s and by " +
                   fixed(other, 2) + " elsewhere");
  }
  constexpr int kFine = 20;
  const double middle_s = best.offset_s;
  for (int i = -kFine; i <= kFine; ++i) {
    const double offset_s = middle_s + step_s * i / kFine;
    const double r = comparison.correlation_at(offset_s);
    if (r > best.correlation) best = {offset_s, r};
  }
  return ClockOffset{best.offset_s, best.correlation, signal == Signal::turns};
}

}  // namespace milepost
