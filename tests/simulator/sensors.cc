#include "tests/simulator/sensors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace milepost::simulator {
namespace {

constexpr double kAntennaM = 1.5;

constexpr double kGpsPeriodS = 1;
constexpr double kGpsMemoryS = 30;
constexpr double kOpenSigmaM = 2.5;
constexpr double kHiddenSigmaM = 13;  // additional sigma if no sky is visible

constexpr double kOdometerPeriodS = 0.1;
constexpr double kSpeedScaleError = 0.015;
constexpr double kSpeedNoiseMps = 0.05;
constexpr double kYawDriftDps = 0.15;
constexpr double kYawNoiseDps = 0.25;

// A first-order Gauss-Markov process of unit variance with time constant kGpsMemoryS.
double next_error(double error, cv::RNG& random) {
  const double kept = std::exp(-kGpsPeriodS / kGpsMemoryS);
  return error * kept + random.gaussian(std::sqrt(1 - kept * kept));
}

}  // namespace

double to_milliseconds(double time_s) { return std::round(time_s * 1000) / 1000; }

GeoPoint geo_from_point(const Point& point) {
  return LocalFrame(kOrigin).geo_from_enu({point[0], point[1], point[2]});
}

double receiver_sigma_m(double open_share) {
  return kOpenSigmaM + kHiddenSigmaM * (1 - std::clamp(open_share, 0.0, 1.0));
}

std::vector<GpsFix> receive(const Motion& motion, const SkyView& sky_view, cv::RNG& random) {
  std::vector<GpsFix> fixes;
  cv::Vec2d error(random.gaussian(1), random.gaussian(1));
  const double leaning = random.uniform(0, 2) == 0 ? -1 : 1;
  for (double time_s = motion.start_s(); time_s <= motion.end_s(); time_s += kGpsPeriodS) {
    const double along = motion.along_m_at(time_s);
    const cv::Vec2d at = motion.position_at(along);
    const double open = sky_view.open_share(at, kAntennaM);
    const double sigma = receiver_sigma_m(open);
    const cv::Vec2d bias =
        right_of(motion.heading_rad_at(along)) * (leaning * 0.3 * (sigma - kOpenSigmaM));
    const cv::Vec2d seen = at + error * (sigma / std::numbers::sqrt2) + bias;
    GpsFix fix{to_milliseconds(time_s), geo_from_point({seen[0], seen[1], kAntennaM}), sigma};
    fix.position.altitude_m = 0;
    fixes.push_back(fix);
    for (int i = 0; i < 2; ++i) error[i] = next_error(error[i], random);
  }
  return fixes;
}

std::vector<Odometry> measure_wheels(const Motion& motion, cv::RNG& random) {
  const double scale = 1 + random.gaussian(kSpeedScaleError);
  const double drift_dps = random.gaussian(kYawDriftDps);
  std::vector<Odometry> readings;
  for (double time_s = motion.start_s(); time_s <= motion.end_s(); time_s += kOdometerPeriodS) {
    const double before_m = motion.along_m_at(time_s - kOdometerPeriodS / 2);
    const double after_m = motion.along_m_at(time_s + kOdometerPeriodS / 2);
    const double turned_rad = std::remainder(
        motion.heading_rad_at(after_m) - motion.heading_rad_at(before_m), 2 * std::numbers::pi);
    // Along the lane: in a bend it is longer or shorter than the route's line.
    const double driven_m = cv::norm(motion.position_at(after_m) - motion.position_at(before_m));
    const double speed = driven_m / kOdometerPeriodS * scale + random.gaussian(kSpeedNoiseMps);
    readings.push_back(
        {to_milliseconds(time_s), std::max(0.0, speed),
         turned_rad * kDegPerRad / kOdometerPeriodS + drift_dps + random.gaussian(kYawNoiseDps)});
  }
  return readings;
}

cv::Mat sensed(const cv::Mat& picture, double noise_levels, cv::RNG& random) {
  constexpr double kWantedMean = 112;
  const cv::Scalar mean = cv::mean(picture);
  const double brightness = (mean[0] + mean[1] + mean[2]) / 3;
  const double gain = std::clamp(std::sqrt(kWantedMean / std::max(brightness, 1.0)), 0.85, 1.35);
  cv::Mat noise(picture.size(), CV_32FC3);
  random.fill(noise, cv::RNG::NORMAL, 0, noise_levels);
  cv::Mat bright;
  picture.convertTo(bright, CV_32FC3, gain);
  bright += noise;
  cv::Mat result;
  bright.convertTo(result, CV_8UC3);
  return result;
}

}  // namespace milepost::simulator
