#include "tests/simulator/sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

// A street northwards along east 0: open up to north 300, then between walls 18 m high.
SkyView half_canyon() {
  cv::Mat height(700, 60, CV_32F, cv::Scalar(0));
  height(cv::Rect(0, 300, 22, 400)) = 18;
  height(cv::Rect(38, 300, 22, 400)) = 18;
  return {height, {-30, 0}};
}

Motion northwards(double from_m, double to_m) {
  MotionPlan plan;
  plan.from_m = from_m;
  plan.to_m = to_m;
  plan.cruise_mps = 5;
  return {Path::through({{{0, 0}}, {{0, 700}}}), 0, plan};
}

struct Errors {
  double across_m, along_m, stated_m;  // root mean squares
};

// Over many receivers, because the errors of one are correlated.
Errors errors_between(const SkyView& sky_view, double from_m, double to_m) {
  const LocalFrame frame(kOrigin);
  const Motion motion = northwards(from_m, to_m);
  double across = 0, along = 0, stated = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    cv::RNG random = seeded(seed);
    for (const GpsFix& fix : receive(motion, sky_view, random)) {
      const EnuPoint seen = frame.enu_from_geo(fix.position);
      const cv::Vec2d truth = motion.position_at(motion.along_m_at(fix.timestamp_s));
      across += std::pow(seen.east_m - truth[0], 2);
      along += std::pow(seen.north_m - truth[1], 2);
      stated += fix.sigma_m * fix.sigma_m;
      ++count;
    }
  }
  return {std::sqrt(across / count), std::sqrt(along / count), std::sqrt(stated / count)};
}

TEST(Receiver, ErrsMoreBetweenTallHousesAndSaysSo) {
  const SkyView sky_view = half_canyon();
  const Errors open = errors_between(sky_view, 50, 230);
  const Errors canyon = errors_between(sky_view, 400, 650);
  EXPECT_NEAR(open.stated_m, 2.6, 0.3);
  EXPECT_GT(canyon.stated_m, 2.5 * open.stated_m);
  EXPECT_GT(canyon.along_m, 2.0 * open.along_m);
  EXPECT_GT(canyon.across_m, 1.05 * canyon.along_m);  // reflections come from the sides
  // The stated sigma is the actual one, apart from the bias.
  EXPECT_NEAR(open.along_m * std::sqrt(2.0) / open.stated_m, 1, 0.15);
  EXPECT_NEAR(canyon.along_m * std::sqrt(2.0) / canyon.stated_m, 1, 0.15);
}

TEST(Receiver, ErrorsOfOneSecondToTheNextAreAlike) {
  const SkyView sky_view = half_canyon();
  const LocalFrame frame(kOrigin);
  const Motion motion = northwards(400, 650);
  cv::RNG random(3);
  const auto fixes = receive(motion, sky_view, random);
  double step = 0, size = 0;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const auto error = [&](const GpsFix& fix) {
      const double north = frame.enu_from_geo(fix.position).north_m;
      return north - motion.position_at(motion.along_m_at(fix.timestamp_s))[1];
    };
    step += std::pow(error(fixes[i]) - error(fixes[i - 1]), 2);
    size += fixes[i].sigma_m * fixes[i].sigma_m / 2;
  }
  EXPECT_LT(step / size, 0.3);  // 2 would be independent errors
}

TEST(Odometry, MeasuresSpeedAndTurnWithinItsErrors) {
  const Motion straight = northwards(0, 300);
  cv::RNG random(5);
  for (const Odometry& reading : measure_wheels(straight, random)) {
    const double speed = straight.speed_mps_at(reading.timestamp_s);
    EXPECT_NEAR(reading.speed_mps, speed, 0.06 * speed + 0.25);
    EXPECT_NEAR(reading.yaw_rate_dps, 0, 1.6);
  }
  MotionPlan plan;
  plan.from_m = 1;
  plan.to_m = 70;
  plan.cruise_mps = 4;
  const Motion turning(Path::circle({0, 0}, 12), 0, plan);
  const auto readings = measure_wheels(turning, random);
  const Odometry& reading = readings[readings.size() / 2];
  const double expected_dps = -reading.speed_mps / 12 * 180 / CV_PI;  // counter-clockwise
  EXPECT_NEAR(reading.yaw_rate_dps, expected_dps, 2.5);
}

TEST(Odometry, IsLongerOnTheOutsideOfABend) {
  MotionPlan plan;
  plan.from_m = 1;
  plan.to_m = 70;
  plan.cruise_mps = 4;
  const Motion outside(Path::circle({0, 0}, 12), 3, plan);  // counter-clockwise, 3 m to the right
  cv::RNG random(5);
  const auto readings = measure_wheels(outside, random);
  const Odometry& reading = readings[readings.size() / 2];
  EXPECT_NEAR(reading.speed_mps / outside.speed_mps_at(reading.timestamp_s), 15.0 / 12, 0.08);
}

TEST(Camera, ExposesDarkPicturesLonger) {
  cv::RNG random(1);
  const cv::Mat dark(40, 40, CV_8UC3, cv::Scalar::all(70));
  const cv::Mat result = sensed(dark, 3, random);
  cv::Scalar mean, deviation;
  cv::meanStdDev(result, mean, deviation);
  EXPECT_GT(mean[1], 80);
  EXPECT_NEAR(deviation[1], 3, 0.4);
}

}  // namespace
}  // namespace milepost::simulator
