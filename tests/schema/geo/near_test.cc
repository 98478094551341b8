#include "schema/geo/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace milepost {
namespace {

// The box test is compared with geodesics.
TEST(BoundsAround, NeverRulesOutWhatIsWithin) {
  const std::vector<GeoPoint> corners = {{0, 0, 0},      {60, 10, 0},      {-60, -10, 0},
                                         {85, 179.9, 0}, {0, -179.999, 0}, {89.99, 0, 0}};
  for (const GeoPoint& corner : corners) {
    const Bounds box = bounds_around({corner});
    for (int direction = 0; direction < 360; direction += 15) {
      const LocalFrame frame(corner);
      const double angle = direction * 3.14159265358979 / 180;
      const GeoPoint there =
          frame.geo_from_enu({4000 * std::sin(angle), 4000 * std::cos(angle), 0});
      const double distance_m = geodesic_distance_m(corner, there);
      EXPECT_TRUE(may_be_within(box, there, distance_m)) << corner.latitude_deg << ' ' << direction;
    }
  }
}

TEST(BoundsAround, RulesOutWhatIsFar) {
  const Bounds box = bounds_around({{49, 8, 0}, {49.01, 8.02, 0}});
  EXPECT_TRUE(may_be_within(box, {49.005, 8.01, 0}, 1));
  EXPECT_TRUE(may_be_within(box, {49.0105, 8.01, 0}, 60));
  EXPECT_FALSE(may_be_within(box, {49.0105, 8.01, 0}, 50));
  EXPECT_TRUE(may_be_within(box, {49.005, 8.021, 0}, 80));
  EXPECT_FALSE(may_be_within(box, {49.005, 8.021, 0}, 60));
  EXPECT_FALSE(may_be_within(box, {49.005, -172, 0}, 10000));
  const Bounds west = bounds_around({{0, -179.9999, 0}});
  EXPECT_TRUE(may_be_within(west, {0, 179.9999, 0}, 30));
  EXPECT_FALSE(may_be_within(west, {0, 179.9999, 0}, 10));
}

TEST(BoxedLine, FindsTheNearestPointWithinTheRadius) {
  const LocalFrame frame({49, 8.4, 0});
  const BoxedLine line(
      *RouteLine::from_vertices({frame.geo_from_enu({0, 0, 0}), frame.geo_from_enu({0, 100, 0})}));
  const GeoPoint beside = frame.geo_from_enu({20, 40, 0});
  ASSERT_TRUE(line.nearest_within(beside, 21));
  EXPECT_NEAR(line.nearest_within(beside, 21)->along_m, 40, 0.01);
  EXPECT_NEAR(line.nearest_within(beside, 21)->distance_m, 20, 0.01);
  EXPECT_FALSE(line.nearest_within(beside, 19));
  EXPECT_FALSE(line.nearest_within({49, 9.4, 0}, 1000));
}

TEST(NearRadius, IsMoreThanNothingAndAtMostTenKilometres) {
  EXPECT_TRUE(is_near_radius(0.001));
  EXPECT_TRUE(is_near_radius(10000));
  EXPECT_FALSE(is_near_radius(0));
  EXPECT_FALSE(is_near_radius(-1));
  EXPECT_FALSE(is_near_radius(10000.1));
  EXPECT_FALSE(is_near_radius(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace milepost
