#include <algorithm>
#include <cmath>

#include "client/evaluate/baselines/along_filter.h"
#include "client/evaluate/baselines/arc_length_tracker.h"
#include "client/evaluate/baselines/kalman.h"

namespace milepost {
namespace {

std::unique_ptr<AlongFilter> make_filter(const PaperTrackerSettings& settings) {
  return settings.filter == PaperFilter::particle
             ? make_particle_filter(settings.particles, settings.seed)
             : make_kalman_filter();
}

AlongBelief as_measured(const Measurement& measurement) {
  return {measurement.along_m, measurement.sigma_m * measurement.sigma_m};
}

class PaperTracker : public ArcLengthTracker {
 public:
  explicit PaperTracker(const PaperTrackerSettings& settings)
      : settings_(settings), filter_(make_filter(settings)) {}
  PaperTracker(const PaperTracker& other)
      : settings_(other.settings_),
        filter_(other.filter_->clone()),
        latest_s_(other.latest_s_),
        before_(other.before_),
        frames_(other.frames_) {}

  std::unique_ptr<ArcLengthTracker> clone() const override {
    return std::make_unique<PaperTracker>(*this);
  }

  void start(double timestamp_s, const Measurement& measurement) override {
    latest_s_ = timestamp_s;
    filter_->reset(as_measured(measurement));
    before_.reset();
    frames_ = 1;
  }

  TrackedPose predict(double timestamp_s) const override {
    const AlongBelief predicted =
        milepost::predict(filter_->belief(), step_to(timestamp_s), settings_.sigma_w_m);
    return {predicted.along_m, std::sqrt(predicted.variance_m2)};
  }

  AlongRange search_region(double timestamp_s) const override {
    const double step_m = before_ ? step_to(timestamp_s) : max_step_m(timestamp_s) / settings_.rho;
    const double latest_m = filter_->belief().along_m;
    return AlongRange{latest_m, latest_m + settings_.rho * step_m}.widened(settings_.min_region_m);
  }

  bool advance(double timestamp_s, const std::optional<Measurement>& measurement) override {
    const Instant latest = {filter_->belief().along_m, latest_s_};
    filter_->predict(step_to(timestamp_s), settings_.sigma_w_m);
    const bool is_measured = measurement && measurement->support >= settings_.min_support;
    if (is_measured) {
      const bool visual_only =
          settings_.filter == PaperFilter::none || frames_ < settings_.first_frames;
      if (visual_only) {
        filter_->reset(as_measured(*measurement));
      } else {
        filter_->update(*measurement, variance_weight(filter_->belief(), *measurement));
      }
      ++frames_;
    }
    before_ = latest;
    latest_s_ = timestamp_s;
    return is_measured;
  }

  TrackedPose pose() const override {
    const AlongBelief belief = filter_->belief();
    return {belief.along_m, std::sqrt(belief.variance_m2)};
  }

 private:
  struct Instant {
    double along_m = 0;
    double time_s = 0;
  };

  // Section 4.2.3: the motion model has little weight until the innovation exceeds a threshold.
  double variance_weight(const AlongBelief& predicted, const Measurement& measurement) const {
    const double innovation_m = std::abs(measurement.along_m - predicted.along_m);
    return innovation_m <= settings_.innovation_threshold_m ? settings_.weight_within
                                                            : settings_.weight_beyond;
  }

  // Eq. 16, limited to forward motion up to the maximum speed.
  double step_to(double timestamp_s) const {
    if (!before_) return 0;
    const double step_m = constant_velocity_step_m(
        before_->along_m, before_->time_s, filter_->belief().along_m, latest_s_, timestamp_s);
    return std::clamp(step_m, 0.0, max_step_m(timestamp_s));
  }

  double max_step_m(double timestamp_s) const {
    return settings_.max_speed_mps * (timestamp_s - latest_s_);
  }

  PaperTrackerSettings settings_;
  std::unique_ptr<AlongFilter> filter_;
  double latest_s_ = 0;
  std::optional<Instant> before_;
  int frames_ = 0;
};

}  // namespace

std::unique_ptr<ArcLengthTracker> make_paper_tracker(const PaperTrackerSettings& settings) {
  return std::make_unique<PaperTracker>(settings);
}

}  // namespace milepost
