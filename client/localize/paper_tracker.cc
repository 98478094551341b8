#include <algorithm>
#include <cmath>

#include "client/localize/kalman.h"
#include "client/localize/tracker.h"

namespace milepost {
namespace {

class PaperTracker : public Tracker {
 public:
  explicit PaperTracker(const PaperTrackerSettings& settings) : settings_(settings) {}

  void start(double timestamp_s, const Measurement& measurement) override {
    latest_s_ = timestamp_s;
    belief_ = {measurement.along_m, measurement.sigma_m * measurement.sigma_m};
    before_.reset();
    frames_ = 1;
  }

  TrackedPosition predict(double timestamp_s) const override {
    const AlongBelief predicted = predicted_at(timestamp_s);
    return {predicted.along_m, std::sqrt(predicted.variance_m2)};
  }

  AlongRange search_region(double timestamp_s) const override {
    const double step_m = before_ ? step_to(timestamp_s) : max_step_m(timestamp_s) / settings_.rho;
    return AlongRange{belief_.along_m, belief_.along_m + settings_.rho * step_m}.widened(
        settings_.min_region_m);
  }

  bool advance(double timestamp_s, const std::optional<Measurement>& measurement) override {
    const AlongBelief predicted = predicted_at(timestamp_s);
    AlongBelief next = predicted;
    if (measurement) {
      const bool visual_only = !settings_.filter || frames_ < settings_.first_frames;
      next = visual_only
                 ? AlongBelief{measurement->along_m, measurement->sigma_m * measurement->sigma_m}
                 : update(predicted, *measurement, variance_weight(predicted, *measurement));
      ++frames_;
    }
    before_ = Instant{belief_.along_m, latest_s_};
    belief_ = next;
    latest_s_ = timestamp_s;
    return measurement.has_value();
  }

  TrackedPosition position() const override {
    return {belief_.along_m, std::sqrt(belief_.variance_m2)};
  }

 private:
  struct Instant {
    double along_m = 0;
    double time_s = 0;
  };

  // Section 4.2.3: the motion model has little say until the measurement is off by a threshold.
  double variance_weight(const AlongBelief& predicted, const Measurement& measurement) const {
    const double innovation_m = std::abs(measurement.along_m - predicted.along_m);
    return innovation_m <= settings_.innovation_threshold_m ? settings_.weight_within
                                                            : settings_.weight_beyond;
  }

  AlongBelief predicted_at(double timestamp_s) const {
    return milepost::predict(belief_, step_to(timestamp_s), settings_.sigma_w_m);
  }

  // Eq. 16 within what a vehicle on its way along the segment can do.
  double step_to(double timestamp_s) const {
    if (!before_) return 0;
    const double step_m = constant_velocity_step_m(before_->along_m, before_->time_s,
                                                   belief_.along_m, latest_s_, timestamp_s);
    return std::clamp(step_m, 0.0, max_step_m(timestamp_s));
  }

  double max_step_m(double timestamp_s) const {
    return settings_.max_speed_mps * (timestamp_s - latest_s_);
  }

  PaperTrackerSettings settings_;
  AlongBelief belief_;
  double latest_s_ = 0;
  std::optional<Instant> before_;
  int frames_ = 0;
};

}  // namespace

std::unique_ptr<Tracker> make_paper_tracker(const PaperTrackerSettings& settings) {
  return std::make_unique<PaperTracker>(settings);
}

}  // namespace milepost
