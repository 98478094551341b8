#include "tests/simulator/position_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost::simulator {
namespace {

std::vector<double> each_two_metres(double length_m) {
  std::vector<double> alongs_m;
  for (double along = 0; along < length_m; along += 2) alongs_m.push_back(along);
  return alongs_m;
}

// The correlation of the east errors of frames `lag` apart, over many drives.
double correlation(const PositionErrors& sizes, std::size_t lag) {
  double products = 0, squares = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto errors = draw_errors(sizes, each_two_metres(2000), seed);
    for (std::size_t i = 0; i + lag < errors.size(); ++i) {
      products += errors[i].position[0] * errors[i + lag].position[0];
      squares += errors[i].position[0] * errors[i].position[0];
    }
  }
  return products / squares;
}

double deviation(const PositionErrors& sizes, int axis) {
  double squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    for (const PoseError& error : draw_errors(sizes, each_two_metres(100), seed)) {
      squares += error.position[axis] * error.position[axis];
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(PositionErrors, AreNoneUnlessAskedFor) {
  for (const PoseError& error : draw_errors({}, each_two_metres(100), 1)) {
    EXPECT_EQ(error.position, Point(0, 0, 0));
    EXPECT_EQ(error.heading_deg, 0);
  }
}

TEST(PositionErrors, HaveTheSizeThatIsAskedFor) {
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(deviation({0.3, 0, 0, 0}, axis), 0.3, 0.01);
    EXPECT_NEAR(deviation({0, 0.3, 0, 0}, axis), 0.3, 0.03);
    EXPECT_NEAR(deviation({0, 0, 0.3, 0}, axis), 0.3, 0.03);
  }
  EXPECT_EQ(deviation({0, 0, 0, 2}, 0), 0);
}

TEST(PositionErrors, NoiseIsWhiteDriftIsSlowAndABiasStays) {
  EXPECT_NEAR(correlation({0.3, 0, 0, 0}, 1), 0, 0.02);
  EXPECT_GT(correlation({0, 0.3, 0, 0}, 10), 0.95);  // 20 m
  EXPECT_GT(correlation({0, 0.3, 0, 0}, 50), 0.5);   // 100 m
  EXPECT_LT(correlation({0, 0.3, 0, 0}, 300), 0.3);  // 600 m
  EXPECT_NEAR(correlation({0, 0, 0.3, 0}, 300), 1, 0.3);
}

TEST(PositionErrors, DifferFromDriveToDrive) {
  const PositionErrors sizes{0.1, 0.1, 0.1, 0.1};
  const auto one = draw_errors(sizes, {0, 2}, 1);
  EXPECT_EQ(one[1].position, draw_errors(sizes, {0, 2}, 1)[1].position);
  EXPECT_NE(one[1].position, draw_errors(sizes, {0, 2}, 2)[1].position);
}

}  // namespace
}  // namespace milepost::simulator
