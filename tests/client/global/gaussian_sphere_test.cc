#include "client/global/gaussian_sphere.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

namespace milepost {
namespace {

const Pinhole kView{500, 400, 320, 240};

TEST(GaussianSphere, APixelsDirectionIsUnitXRightYDown) {
  const Eigen::Vector3d corner = direction_of_pixel(kView, {820, 640});
  EXPECT_TRUE(corner.isApprox(Eigen::Vector3d(1, 1, 1) / std::sqrt(3.0))) << corner.transpose();
}

TEST(GaussianSphere, ACircleHoldsTheSegmentsEnds) {
  const LineSegment segment{{100, 50}, {400, 300}};
  const GreatCircle circle = great_circle(kView, segment, {});
  EXPECT_NEAR(circle.arc_distance_rad(direction_of_pixel(kView, segment.start_px)), 0, 1e-12);
  EXPECT_NEAR(circle.arc_distance_rad(direction_of_pixel(kView, segment.end_px)), 0, 1e-12);
  EXPECT_NEAR(circle.arc_distance_rad(circle.normal), std::numbers::pi / 2, 1e-7);
}

// Compared with many segments with noisy ends.
TEST(GaussianSphere, SigmaIsTheSpreadThatMovedEndsMake) {
  const Pinhole view{500, 500, 320, 240};
  const Eigen::Vector2d start(300, 200);
  const Eigen::Vector2d end(360, 200);
  const GreatCircle circle = great_circle(view, {start, end}, {0.5, 0});
  std::mt19937 random(1);
  std::normal_distribution<double> across_px(0, 0.5);
  for (const double angle_rad : {0.0, 0.4, 1.5}) {
    const Eigen::Vector3d direction =
        std::cos(angle_rad) * circle.middle + std::sin(angle_rad) * circle.along;
    double squares = 0;
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
      const LineSegment moved{start + Eigen::Vector2d(0, across_px(random)),
                              end + Eigen::Vector2d(0, across_px(random))};
      const double off = great_circle(view, moved, {}).normal.dot(direction);
      squares += off * off;
    }
    const double spread_rad = std::sqrt(squares / kDraws);
    EXPECT_NEAR(circle.sigma_rad(direction) / spread_rad, 1, 0.03) << angle_rad;
  }
}

TEST(GaussianSphere, CirclesMeetInTheDirectionOfParallelLines) {
  // Both towards the pixel (320, -160): direction (0, -1, 1).
  const std::vector<GreatCircle> circles = {
      great_circle(kView, {{120, 240}, {220, 40}}, {}),
      great_circle(kView, {{520, 240}, {420, 40}}, {}),
      great_circle(kView, {{520.1, 240}, {420.1, 40}}, {}),
  };
  const auto points = intersections(circles, 0.01);
  ASSERT_EQ(points.size(), 2u);  // the last two almost coincide
  EXPECT_TRUE(points[0].isApprox(Eigen::Vector3d(0, -1, 1).normalized(), 1e-9))
      << points[0].transpose();
}

}  // namespace
}  // namespace milepost
