#include "client/global/view_sections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "schema/geo/camera_pose.h"
#include "schema/geo/pinhole.h"

namespace milepost {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

const Pinhole kView{400, 400, 300, 250};

// Up and two horizontal directions, ahead and 60 degrees to the right, in the frame of a camera
// with this pitch and roll.
VanishingDirections seen_with(double pitch_rad, double roll_rad) {
  CameraPose pose;
  pose.pitch_rad = pitch_rad;
  pose.roll_rad = roll_rad;
  const auto direction = [&](double east, double north, double up) {
    return (camera_from_enu(pose) * Eigen::Vector3d(east, north, up)).normalized();
  };
  VanishingDirections found;
  found.directions = {{direction(0, 0, 1), Orientation::vertical, 9},
                      {direction(0, 1, 0), Orientation::horizontal, 9},
                      {direction(std::sqrt(3), 1, 0), Orientation::horizontal, 9}};
  return found;
}

void add_line(VanishingDirections& found, const Eigen::Vector2d& start_px,
              const Eigen::Vector2d& end_px, std::optional<std::size_t> direction) {
  found.lines.push_back({{start_px, end_px}, direction});
}

double bearing_of_column(double x_px) {
  return std::atan2(x_px - kView.principal_x_px, kView.focal_x_px);
}

TEST(LevelFromCamera, UndoesPitchAndRoll) {
  const Eigen::Matrix3d level = level_from_camera(seen_with(0.2, -0.3));
  CameraPose pose;
  pose.heading_rad = 0;
  const Eigen::Matrix3d expected = camera_from_enu(pose);
  CameraPose add_tilt_noise = pose;
  add_tilt_noise.pitch_rad = 0.2;
  add_tilt_noise.roll_rad = -0.3;
  EXPECT_TRUE((level * camera_from_enu(add_tilt_noise)).isApprox(expected, 1e-9));
}

TEST(LevelFromCamera, IsTheCamerasOwnWhereNoVerticalIsSeen) {
  EXPECT_TRUE(level_from_camera({}).isIdentity());
  VanishingDirections found = seen_with(0.2, 0);
  found.directions.erase(found.directions.begin());
  EXPECT_TRUE(level_from_camera(found).isIdentity());
}

TEST(ViewSections, AreTheBearingsOverWhichTheSameOrientationsAreSeen) {
  VanishingDirections found = seen_with(0, 0);
  add_line(found, {100, 100}, {300, 120}, 1);
  add_line(found, {400, 90}, {200, 80}, 2);
  const std::vector<ViewSection> sections = view_sections(found, kView);
  ASSERT_EQ(sections.size(), 3U);
  EXPECT_NEAR(sections[0].bearings.from_rad, bearing_of_column(100), 1e-9);
  EXPECT_NEAR(sections[0].bearings.to_rad, bearing_of_column(200), 1e-9);
  EXPECT_THAT(sections[0].orientations_rad, ElementsAre(DoubleNear(0, 1e-9)));
  EXPECT_NEAR(sections[1].bearings.to_rad, bearing_of_column(300), 1e-9);
  EXPECT_THAT(sections[1].orientations_rad,
              ElementsAre(DoubleNear(0, 1e-9), DoubleNear(std::numbers::pi / 3, 1e-9)));
  EXPECT_NEAR(sections[2].bearings.to_rad, bearing_of_column(400), 1e-9);
  EXPECT_THAT(sections[2].orientations_rad, ElementsAre(DoubleNear(std::numbers::pi / 3, 1e-9)));
}

TEST(ViewSections, LinesOfOneOrientationSideBySideAreOneSection) {
  VanishingDirections found = seen_with(0, 0);
  add_line(found, {100, 100}, {200, 120}, 1);
  add_line(found, {150, 80}, {300, 60}, 1);
  const std::vector<ViewSection> sections = view_sections(found, kView);
  ASSERT_EQ(sections.size(), 1U);
  EXPECT_NEAR(sections[0].bearings.to_rad, bearing_of_column(300), 1e-9);
}

TEST(ViewSections, GapsAreNone) {
  VanishingDirections found = seen_with(0, 0);
  add_line(found, {100, 100}, {200, 120}, 1);
  add_line(found, {350, 80}, {400, 60}, 1);
  EXPECT_EQ(view_sections(found, kView).size(), 2U);
}

TEST(ViewSections, UprightLinesLinesOfNoneAndLinesOnTheGroundAreLeftOut) {
  VanishingDirections found = seen_with(0, 0);
  add_line(found, {100, 100}, {105, 200}, 0);
  add_line(found, {100, 100}, {200, 120}, std::nullopt);
  add_line(found, {100, 400}, {200, 300}, 1);
  EXPECT_TRUE(view_sections(found, kView).empty());
}

// Other lines change nothing; a line that reaches above the horizon counts, one behind the camera
// does not.
TEST(ViewSections, EachLineIsJudgedByItself) {
  VanishingDirections found = seen_with(0, 0);
  add_line(found, {100, 100}, {200, 120}, std::nullopt);
  add_line(found, {250, 300}, {350, 240}, 1);
  add_line(found, {100, 100}, {105, 200}, 0);
  add_line(found, {400, 90}, {450, 80}, 2);
  const std::vector<ViewSection> sections = view_sections(found, kView);
  ASSERT_EQ(sections.size(), 2U);
  EXPECT_NEAR(sections[0].bearings.from_rad, bearing_of_column(250), 1e-9);
  EXPECT_NEAR(sections[1].bearings.to_rad, bearing_of_column(450), 1e-9);
}

TEST(ViewSections, AGapPartsLinesOfOneOrientation) {
  VanishingDirections found = seen_with(0, 0);
  add_line(found, {100, 100}, {200, 120}, 1);
  add_line(found, {300, 100}, {400, 120}, 1);
  add_line(found, {200, 90}, {300, 90}, 2);
  const std::vector<ViewSection> sections = view_sections(found, kView);
  ASSERT_EQ(sections.size(), 3U);
  EXPECT_THAT(sections[1].orientations_rad, ElementsAre(DoubleNear(std::numbers::pi / 3, 1e-9)));
  EXPECT_NEAR(sections[2].bearings.from_rad, bearing_of_column(300), 1e-9);
}

TEST(ViewSections, AnUprightImageOfALineHasNoWidth) {
  VanishingDirections found = seen_with(0, 0);
  add_line(found, {300, 100}, {300, 200}, 1);
  EXPECT_TRUE(view_sections(found, kView).empty());
}

// As the paper claims: roll and tilt have no effect.
TEST(ViewSections, TiltDoesNotTurnThem) {
  VanishingDirections found = seen_with(0.15, 0.2);
  add_line(found, {250, 100}, {300, 90}, 2);
  const std::vector<ViewSection> sections = view_sections(found, kView);
  ASSERT_EQ(sections.size(), 1U);
  EXPECT_THAT(sections[0].orientations_rad, ElementsAre(DoubleNear(std::numbers::pi / 3, 1e-9)));
}

}  // namespace
}  // namespace milepost
