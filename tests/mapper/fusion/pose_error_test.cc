#include "mapper/fusion/pose_error.h"

#include <gtest/gtest.h>

#include "tests/mapper/made_up_street.h"

namespace milepost {
namespace {

using testing::MadeUpStreet;

TEST(PoseError, ARollLiftsWhatIsOnTheLeft) {
  const RouteLine to_the_east =
      RouteLine::from_vertices({MadeUpStreet::geo_of({0, 0, 0}), MadeUpStreet::geo_of({100, 0, 0})})
          .value();
  const RoadPlace place = road_place(to_the_east, 40);
  EXPECT_LT((place.forward - Eigen::Vector3d::UnitX()).norm(), 1e-5);
  const PoseError error{{0.3, 0.2, 0.1}, 0.01};
  const Eigen::Vector3d of_left = error.displacement_m(place, {10, 7, 3});
  EXPECT_LT((of_left - Eigen::Vector3d(0.3, 0.2 - 0.03, 0.1 + 0.07)).norm(), 1e-4);
  EXPECT_FALSE(error.is_zero());
  EXPECT_FALSE((PoseError{{0, 0, 0}, 0.01}).is_zero());
  EXPECT_TRUE(PoseError().is_zero());
}

}  // namespace
}  // namespace milepost
