#include <algorithm>
#include <cmath>

#include "client/evaluate/baselines/arc_length_tracker.h"
#include "client/evaluate/baselines/kalman.h"

namespace milepost {
namespace {

class MotionTracker : public ArcLengthTracker {
 public:
  explicit MotionTracker(const MotionTrackerSettings& settings) : settings_(settings) {}

  std::unique_ptr<ArcLengthTracker> clone() const override {
    return std::make_unique<MotionTracker>(*this);
  }

  void start(double timestamp_s, const Measurement& measurement) override {
    latest_s_ = timestamp_s;
    refusals_ = 0;
    shared_sigma_m_ = measurement.shared_sigma_m;
    belief_.x = {measurement.along_m, settings_.start_speed_mps};
    belief_.P = Eigen::Vector2d(measurement.sigma_m * measurement.sigma_m,
                                settings_.start_speed_sigma_mps * settings_.start_speed_sigma_mps)
                    .asDiagonal();
  }

  TrackedPose predict(double timestamp_s) const override {
    return position_of(predicted_at(timestamp_s));
  }

  AlongRange search_region(double timestamp_s) const override {
    const TrackedPose expected = predict(timestamp_s);
    const double reach_m =
        std::max(settings_.min_region_m, settings_.region_sigmas * expected.sigma_m);
    return AlongRange{expected.along_m, expected.along_m}.widened(reach_m);
  }

  bool advance(double timestamp_s, const std::optional<Measurement>& measurement) override {
    const MotionBelief predicted = predicted_at(timestamp_s);
    latest_s_ = timestamp_s;
    belief_ = predicted;
    if (!measurement) return false;
    if (believable(predicted, *measurement)) {
      belief_ = update(predicted, *measurement);
      shared_sigma_m_ = measurement->shared_sigma_m;
      refusals_ = 0;
      return true;
    }
    if (++refusals_ < settings_.max_refusals) return false;
    start(timestamp_s, *measurement);  // the belief was wrong
    return true;
  }

  TrackedPose pose() const override { return position_of(belief_); }

 private:
  bool believable(const MotionBelief& predicted, const Measurement& measurement) const {
    const double innovation_sigma_m = std::hypot(std::sqrt(predicted.P(0, 0)), measurement.sigma_m);
    return std::abs(measurement.along_m - predicted.x[0]) <=
           settings_.gate_sigmas * innovation_sigma_m;
  }

  MotionBelief predicted_at(double timestamp_s) const {
    return milepost::predict(belief_, timestamp_s - latest_s_, settings_.acceleration_sigma);
  }

  // The filter averages out independent errors of frames; shared errors remain.
  TrackedPose position_of(const MotionBelief& belief) const {
    return {belief.x[0], std::hypot(std::sqrt(belief.P(0, 0)), shared_sigma_m_)};
  }

  MotionTrackerSettings settings_;
  MotionBelief belief_;
  double latest_s_ = 0;
  double shared_sigma_m_ = 0;
  int refusals_ = 0;
};

}  // namespace

std::unique_ptr<ArcLengthTracker> make_motion_tracker(const MotionTrackerSettings& settings) {
  return std::make_unique<MotionTracker>(settings);
}

}  // namespace milepost
