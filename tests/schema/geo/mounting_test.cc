#include "schema/geo/mounting.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

const GeoPoint kHere{49, 8.4, 110};

EnuPoint offset_m(const GeoAttitude& from, const GeoAttitude& to) {
  return LocalFrame(from.position).enu_from_geo(to.position);
}

TEST(Mounting, TurnsWithTheVehicle) {
  const Mounting mounting{.forward_m = 1.2, .right_m = -0.4, .up_m = 0.9};
  for (const auto& [heading_deg, east_m, north_m] :
       {std::tuple{0.0, -0.4, 1.2}, {90.0, 1.2, 0.4}, {180.0, 0.4, -1.2}, {270.0, -1.2, -0.4}}) {
    const GeoAttitude vehicle{kHere, heading_deg};
    const GeoAttitude camera = camera_of_vehicle(vehicle, mounting);
    const EnuPoint lever = offset_m(vehicle, camera);
    EXPECT_NEAR(lever.east_m, east_m, 1e-6) << heading_deg;
    EXPECT_NEAR(lever.north_m, north_m, 1e-6) << heading_deg;
    EXPECT_NEAR(lever.up_m, 0.9, 1e-6);
    EXPECT_NEAR(camera.heading_deg, heading_deg, 1e-9);
  }
}

TEST(Mounting, FollowsItsPitchAndRoll) {
  // A vehicle that climbs by 30 degrees lifts what is ahead; one that rolls clockwise lowers what
  // is to its right.
  const Mounting ahead{.forward_m = 2};
  EXPECT_NEAR(offset_m({kHere, 0}, camera_of_vehicle({kHere, 0, 30, 0}, ahead)).up_m, 1, 1e-6);
  const Mounting beside{.right_m = 2};
  EXPECT_NEAR(offset_m({kHere, 0}, camera_of_vehicle({kHere, 0, 0, 30}, beside)).up_m, -1, 1e-6);
}

TEST(Mounting, BoresightAddsToTheAttitude) {
  const GeoAttitude level = camera_of_vehicle({kHere, 350}, {.yaw_deg = 15, .pitch_deg = -4});
  EXPECT_NEAR(level.heading_deg, 5, 1e-9);
  EXPECT_NEAR(level.pitch_deg, -4, 1e-9);
  EXPECT_NEAR(level.roll_deg, 0, 1e-9);
  // A camera that looks to the right of a vehicle that climbs sees it as a roll.
  const GeoAttitude sideways = camera_of_vehicle({kHere, 0, 10, 0}, {.yaw_deg = 90});
  EXPECT_NEAR(sideways.pitch_deg, 0, 1e-9);
  EXPECT_NEAR(std::abs(sideways.roll_deg), 10, 1e-9);
}

TEST(Mounting, IsATransform) {
  const Mounting mounting{1.2, -0.4, 0.9, 3, -2, 1};
  const Mounting back = mounting_of(vehicle_from_camera(mounting));
  EXPECT_NEAR(back.forward_m, 1.2, 1e-12);
  EXPECT_NEAR(back.right_m, -0.4, 1e-12);
  EXPECT_NEAR(back.up_m, 0.9, 1e-12);
  EXPECT_NEAR(back.yaw_deg, 3, 1e-9);
  EXPECT_NEAR(back.pitch_deg, -2, 1e-9);
  EXPECT_NEAR(back.roll_deg, 1, 1e-9);
  // What is 1 m ahead of the vehicle, to its right and above it: x right, y down, z forward.
  const Eigen::Vector3d at =
      vehicle_from_camera({.forward_m = 1, .right_m = 2, .up_m = 3}).translation();
  EXPECT_NEAR((at - Eigen::Vector3d(2, -3, 1)).norm(), 0, 1e-12);
}

TEST(Mounting, IsUndone) {
  const Mounting mounting{1.2, -0.4, 0.9, 3, -2, 1};
  const GeoAttitude vehicle{kHere, 123, 4, -5};
  const GeoAttitude back = vehicle_of_camera(camera_of_vehicle(vehicle, mounting), mounting);
  const EnuPoint off = offset_m(vehicle, back);
  EXPECT_NEAR(std::hypot(off.east_m, off.north_m, off.up_m), 0, 1e-6);
  EXPECT_NEAR(back.heading_deg, 123, 1e-6);
  EXPECT_NEAR(back.pitch_deg, 4, 1e-6);
  EXPECT_NEAR(back.roll_deg, -5, 1e-6);
}

}  // namespace
}  // namespace milepost
