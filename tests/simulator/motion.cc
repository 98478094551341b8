#include "tests/simulator/motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace milepost::simulator {
namespace {

constexpr double kStepM = 0.5;
constexpr double kSidewaysMps2 = 2.0;  // comfortable lateral acceleration in a curve
constexpr double kSpeedingUpMps2 = 1.2;
constexpr double kBrakingMps2 = 1.9;
constexpr double kWalkingMps = 1.8;
constexpr double kWanderPeriodM = 63;

}  // namespace

Motion::Motion(Path path, double lane_m, const MotionPlan& plan)
    : path_(std::move(path)), lane_m_(lane_m), plan_(plan) {
  const std::vector<double> speed = speeds();
  times_s_ = {0};
  for (std::size_t i = 0; i + 1 < speed.size(); ++i) {
    times_s_.push_back(times_s_.back() + 2 * kStepM / (speed[i] + speed[i + 1]));
  }
}

// The limits of the road and the driver first, then those of the engine and the brakes.
std::vector<double> Motion::speeds() const {
  const auto count = static_cast<std::size_t>(std::ceil((plan_.to_m - plan_.from_m) / kStepM)) + 1;
  std::vector<double> speed(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double along = plan_.from_m + kStepM * static_cast<double>(i);
    const double mood = std::sin(along / 23 + static_cast<double>(plan_.seed)) +
                        0.6 * std::sin(along / 9.1 + 2 * static_cast<double>(plan_.seed));
    speed[i] = plan_.cruise_mps * (1 + 0.08 * mood);
    const double curvature = std::abs(path_.curvature_per_m_at(along));
    if (curvature > 0) speed[i] = std::min(speed[i], std::sqrt(kSidewaysMps2 / curvature));
    for (const double slow : plan_.slow_downs_m) {
      if (std::abs(along - slow) < 2) speed[i] = std::min(speed[i], kWalkingMps);
    }
  }
  const auto reachable = [](double from_mps, double acceleration_mps2) {
    return std::sqrt(from_mps * from_mps + 2 * acceleration_mps2 * kStepM);
  };
  for (std::size_t i = 1; i < count; ++i) {
    speed[i] = std::min(speed[i], reachable(speed[i - 1], kSpeedingUpMps2));
  }
  for (std::size_t i = count - 1; i > 0; --i) {
    speed[i - 1] = std::min(speed[i - 1], reachable(speed[i], kBrakingMps2));
  }
  return speed;
}

double Motion::time_s_at(double along_m) const {
  const double steps =
      std::clamp((along_m - plan_.from_m) / kStepM, 0.0, static_cast<double>(times_s_.size() - 1));
  const auto before = std::min(static_cast<std::size_t>(steps), times_s_.size() - 2);
  const double part = steps - static_cast<double>(before);
  return plan_.start_s + std::lerp(times_s_[before], times_s_[before + 1], part);
}

double Motion::along_m_at(double time_s) const {
  const double since_s = time_s - plan_.start_s;
  const auto after = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, since_s);
  const auto before = static_cast<std::size_t>(after - times_s_.begin()) - 1;
  const double part = (since_s - times_s_[before]) / (times_s_[before + 1] - times_s_[before]);
  return plan_.from_m + kStepM * (static_cast<double>(before) + part);
}

double Motion::speed_mps_at(double time_s) const {
  constexpr double kHalfS = 0.02;
  return (along_m_at(time_s + kHalfS) - along_m_at(time_s - kHalfS)) / (2 * kHalfS);
}

double Motion::offset_m_at(double along_m) const {
  double offset = plan_.lateral_m + plan_.wander_m * std::sin(2 * CV_PI * along_m / kWanderPeriodM +
                                                              static_cast<double>(plan_.seed));
  for (const LaneChange& change : plan_.lane_changes) {
    const double part = std::clamp((along_m - change.from_m) / change.over_m, 0.0, 1.0);
    offset += change.by_m * part * part * part * (part * (6 * part - 15) + 10);
  }
  return offset;
}

cv::Vec2d Motion::position_at(double along_m) const {
  return path_.position_at({along_m, lane_m_ + offset_m_at(along_m)});
}

double Motion::heading_rad_at(double along_m) const {
  constexpr double kHalfStepM = 0.4;
  const cv::Vec2d step = position_at(along_m + kHalfStepM) - position_at(along_m - kHalfStepM);
  return std::atan2(step[0], step[1]);
}

}  // namespace milepost::simulator
