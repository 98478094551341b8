#include "client/face/conversions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace milepost::vehicle {
namespace {

constexpr double kMm = 0.001;

Camera sound_camera() {
  Camera camera;
  camera.width_px = 600;
  camera.height_px = 500;
  camera.focal_x_px = 350;
  camera.focal_y_px = 360;
  camera.principal_x_px = 300;
  camera.principal_y_px = 250;
  return camera;
}

TEST(CheckCamera, TakesWhatIsSound) {
  EXPECT_TRUE(check_camera(sound_camera()).ok());
  Camera camera = sound_camera();
  camera.lens = LensModel::brown_conrady;
  camera.distortion = {0, 0, 0, 0};
  EXPECT_TRUE(check_camera(camera).ok());  // no distortion
}

TEST(CheckCamera, RefusesWhatIsOutOfRange) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    Camera camera = sound_camera();
    change(camera);
    const Status status = check_camera(camera);
    return !status.ok() && status.error().code == ErrorCode::invalid_input &&
           !status.error().hint.empty();
  };
  EXPECT_TRUE(refused([](Camera& camera) { camera.width_px = 0; }));
  EXPECT_TRUE(refused([](Camera& camera) { camera.height_px = -1; }));
  EXPECT_TRUE(refused([](Camera& camera) { camera.focal_x_px = 0; }));
  EXPECT_TRUE(refused([&](Camera& camera) { camera.focal_y_px = nothing; }));
  EXPECT_TRUE(refused([&](Camera& camera) { camera.principal_x_px = nothing; }));
  EXPECT_TRUE(refused([&](Camera& camera) { camera.mounting.up_m = nothing; }));
}

TEST(CheckCamera, RefusesALensThatIsNone) {
  Camera camera = sound_camera();
  camera.distortion = {0.1};  // of a pinhole
  EXPECT_EQ(check_camera(camera).error().code, ErrorCode::invalid_input);
  camera.lens = LensModel::kannala_brandt;
  EXPECT_TRUE(check_camera(camera).ok());
  camera.distortion = {0.1, 0, 0, 0, 0};
  EXPECT_EQ(check_camera(camera).error().code, ErrorCode::invalid_input);
}

TEST(PlainCamera, HasTheLensAndTheMounting) {
  Camera camera = sound_camera();
  EXPECT_TRUE(plain_camera_of(camera).lens.is_pinhole());
  camera.lens = LensModel::brown_conrady;
  camera.distortion = {-0.2, 0.03, 0, 1e-4};
  camera.mounting = {.forward_m = 1.2, .yaw_deg = 3};
  const milepost::Camera plain = plain_camera_of(camera);
  EXPECT_EQ(plain.lens, *Lens::make(milepost::LensModel::brown_conrady, camera.distortion));
  EXPECT_EQ(plain.mounting, (milepost::Mounting{.forward_m = 1.2, .yaw_deg = 3}));
  camera.lens = LensModel::kannala_brandt;
  EXPECT_EQ(plain_camera_of(camera).lens.model(), milepost::LensModel::kannala_brandt);
}

TEST(OpenSource, NamesWhatIsWrong) {
  const auto file = open_source(FileSource{"/nowhere/at/all.map"});
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.error().line().find("all.map"), std::string::npos);
  ServerSource server;
  server.url = "ftp://host";
  EXPECT_EQ(open_source(server).error().code, ErrorCode::invalid_input);
}

// Metres east, north and up from the camera to the reference point.
EnuPoint from_camera(const GeoCameraPose& camera, const Pose& pose) {
  return LocalFrame(camera.position)
      .enu_from_geo({pose.latitude_deg, pose.longitude_deg, pose.altitude_m});
}

GeoCameraPose camera_looking(double heading_deg, double pitch_deg, double roll_deg) {
  return {{49, 8.4, 110}, heading_deg, pitch_deg, roll_deg};
}

TEST(VehiclePose, WithoutMountingIsTheCameras) {
  GeoCameraPose camera = camera_looking(123, 4, -2);
  for (int i = 0; i < 36; ++i) camera.covariance[i] = i % 7 == 0 ? 0.01 * (i + 1) : 0;
  const Pose pose = vehicle_pose_of(camera, {});
  EXPECT_NEAR(std::hypot(from_camera(camera, pose).east_m, from_camera(camera, pose).up_m), 0, kMm);
  EXPECT_NEAR(pose.heading_deg, 123, 1e-9);
  EXPECT_NEAR(pose.pitch_deg, 4, 1e-9);
  EXPECT_NEAR(pose.roll_deg, -2, 1e-9);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(pose.covariance[i], camera.covariance[i], 1e-6) << i;
}

// The camera 2 m ahead of the reference point, 0.5 m to its right and 1.5 m above, driving east.
TEST(VehiclePose, TheLeverArmLeadsBackToTheReferencePoint) {
  const GeoCameraPose camera = camera_looking(90, 0, 0);
  Mounting mounting;
  mounting.forward_m = 2;
  mounting.right_m = 0.5;
  mounting.up_m = 1.5;
  const EnuPoint reference = from_camera(camera, vehicle_pose_of(camera, mounting));
  EXPECT_NEAR(reference.east_m, -2, kMm);
  EXPECT_NEAR(reference.north_m, 0.5, kMm);
  EXPECT_NEAR(reference.up_m, -1.5, kMm);
}

TEST(VehiclePose, TheBoresightIsTakenOff) {
  Mounting mounting;
  mounting.yaw_deg = 10;
  const Pose yawed = vehicle_pose_of(camera_looking(100, 0, 0), mounting);
  EXPECT_NEAR(yawed.heading_deg, 90, 1e-9);
  mounting = {};
  mounting.pitch_deg = -5;
  const Pose pitched = vehicle_pose_of(camera_looking(100, -5, 0), mounting);
  EXPECT_NEAR(pitched.pitch_deg, 0, 1e-9);
  EXPECT_NEAR(pitched.heading_deg, 100, 1e-9);
  mounting = {};
  mounting.roll_deg = 3;
  EXPECT_NEAR(vehicle_pose_of(camera_looking(100, 0, 4), mounting).roll_deg, 1, 1e-9);
}

// A camera that looks to the right side of a vehicle that climbs at 10 degrees has a roll of 10
// degrees: the vehicle's right axis is level, and in the image the road rises from right to left.
TEST(VehiclePose, OfACameraThatLooksAsideTurnsPitchIntoRoll) {
  Mounting mounting;
  mounting.yaw_deg = 90;
  const Pose pose = vehicle_pose_of(camera_looking(90, 0, 10), mounting);
  EXPECT_NEAR(pose.heading_deg, 0, 1e-6);
  EXPECT_NEAR(std::abs(pose.pitch_deg), 10, 1e-6);
  EXPECT_NEAR(pose.roll_deg, 0, 1e-6);
}

// One degree of heading moves a reference point 2 m behind the camera by 35 mm sideways.
TEST(VehiclePose, HeadingsUncertaintyMovesTheReferencePoint) {
  GeoCameraPose camera = camera_looking(0, 0, 0);
  camera.covariance[21] = 1;
  Mounting mounting;
  mounting.forward_m = 2;
  const Pose pose = vehicle_pose_of(camera, mounting);
  EXPECT_NEAR(std::sqrt(pose.covariance[0]), 2 * kRadPerDeg, 1e-6);
  EXPECT_NEAR(pose.covariance[7], 0, 1e-9);
  EXPECT_NEAR(pose.covariance[21], 1, 1e-6);
}

// Due south the heading wraps around from -180 to 180 degrees; its uncertainty does not.
TEST(VehiclePose, HeadingsWrapAroundDueSouth) {
  GeoCameraPose camera = camera_looking(180, 0, 0);
  camera.covariance[21] = 0.01;
  const Pose pose = vehicle_pose_of(camera, {});
  EXPECT_NEAR(pose.covariance[21], 0.01, 1e-6);
  EXPECT_NEAR(pose.covariance[28], 0, 1e-6);
}

TEST(Deadline, OfTheLongestPatienceDoesNotOverflow) {
  Patience patience;
  patience.longest = std::chrono::milliseconds::max();
  EXPECT_GT(deadline_of(patience), std::chrono::steady_clock::now() + std::chrono::hours(24));
}

TEST(OpenSource, TimeoutsAreAboveZeroAndBounded) {
  ServerSource server;
  server.url = "http://127.0.0.1:1";
  server.stall_timeout_s = std::numeric_limits<double>::infinity();
  EXPECT_EQ(open_source(server).error().code, ErrorCode::invalid_input);
  server.stall_timeout_s = 0;
  EXPECT_EQ(open_source(server).error().code, ErrorCode::invalid_input);
}

TEST(OpenSource, PublicKeysAreContentsOfTheirFiles) {
  const auto folder = std::filesystem::temp_directory_path() / "milepost-public-keys-test";
  ServerSource server;
  server.url = "http://127.0.0.1:1";
  server.cache_directory = folder;
  server.public_keys = {"milepost-public-key-1 " + std::string(64, '5') + "\n", "operator.key.pub"};
  const auto refused = open_source(server);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::invalid_input);
  EXPECT_NE(refused.error().line().find("public_keys"), std::string::npos);
  server.public_keys.pop_back();
  EXPECT_TRUE(open_source(server).ok());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace milepost::vehicle
