// The camera of a drive: its lens, its mounting, and how it was tilted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "schema/drive/drive.h"
#include "tests/schema/drive/drive_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

TEST(ReadDrive, ReadsTheLens) {
  const DriveFolder folder;
  EXPECT_TRUE(read_drive(folder.path())->camera.lens.is_pinhole());
  const auto lens_of = [&](const std::string& distortion) {
    const DriveFolder with;
    with.replace("drive.json", R"("focal_px")",
                 R"("distortion": )" + distortion + R"(, "focal_px")");
    const Result<Drive> drive = read_drive(with.path());
    EXPECT_TRUE(drive.ok()) << drive.error().line();
    return drive->camera.lens;
  };
  const Lens brown = lens_of(R"({"model": "brown-conrady", "k1": -0.2, "p2": 0.001, "k3": 0.01})");
  EXPECT_EQ(brown.model(), LensModel::brown_conrady);
  EXPECT_EQ(brown.coefficients(), (std::vector<double>{-0.2, 0, 0, 0.001, 0.01, 0, 0, 0}));
  const Lens fisheye = lens_of(R"({"model": "kannala-brandt", "k1": -0.01, "k4": 0.002})");
  EXPECT_EQ(fisheye.model(), LensModel::kannala_brandt);
  EXPECT_EQ(fisheye.coefficients(), (std::vector<double>{-0.01, 0, 0, 0.002}));
  EXPECT_TRUE(lens_of(R"({"model": "pinhole"})").is_pinhole());
}

TEST(ReadDriveRefuses, ALensThatIsNotKnown) {
  const auto refused = [](const std::string& camera) {
    const DriveFolder folder;
    folder.replace("drive.json", R"("focal_px")", camera + R"(, "focal_px")");
    return refusal(folder);
  };
  EXPECT_THAT(refused(R"("distortion": [-0.2, 0.1])"),
              HasSubstr("camera.distortion is not an object; write {\"model\": \"brown-conrady\""));
  EXPECT_THAT(refused(R"("distortion": {"k1": 0})"),
              HasSubstr("camera.distortion.model is missing; "));
  EXPECT_THAT(
      refused(R"("distortion": {"model": "fisheye", "k1": 0})"),
      HasSubstr("camera.distortion.model is 'fisheye'; write brown-conrady, kannala-brandt "));
  EXPECT_THAT(refused(R"("distortion": {"model": "kannala-brandt", "k5": 0})"),
              HasSubstr("camera.distortion.k5 is not known; write one of model, k1, k2, k3, k4"));
  EXPECT_THAT(refused(R"("distortion": {"model": "brown-conrady", "k1": "0"})"),
              HasSubstr("camera.distortion.k1 is not a number; "));
  EXPECT_THAT(refused(R"("distortion": {"model": "brown-conrady", "k1": -500})"),
              HasSubstr("its image folds within 6 degrees of the optical axis; "));
  EXPECT_THAT(refused(R"("distorsion": {"model": "pinhole"})"),
              HasSubstr("camera.distorsion is not known; write one of width_px, "));
}

TEST(ReadDrive, PlacesTheCameraOnItsVehicle) {
  const DriveFolder folder;
  const Result<Drive> at_camera = read_drive(folder.path());
  folder.replace("drive.json", R"("name")",
                 R"("mounting": {"forward_m": 1.2, "right_m": 0.5, "yaw_deg": 3}, "name")");
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_EQ(drive->camera.mounting, (Mounting{.forward_m = 1.2, .right_m = 0.5, .yaw_deg = 3}));
  const std::size_t north = 2;  // the frame whose heading is 0
  const EnuPoint lever =
      LocalFrame(at_camera->frames[north].position).enu_from_geo(drive->frames[north].position);
  EXPECT_NEAR(lever.east_m, 0.5, 1e-6);
  EXPECT_NEAR(lever.north_m, 1.2, 1e-6);
  EXPECT_NEAR(drive->frames[north].heading_deg, 3, 1e-9);
}

TEST(ReadDrive, ReadsPitchAndRoll) {
  const DriveFolder folder;
  EXPECT_FALSE(read_drive(folder.path())->has_tilts);
  folder.write("trajectory.csv",
               "filename,timestamp_s,east_m,north_m,up_m,heading_deg,pitch_deg,roll_deg\n"
               "a.png,1,0,0,0,0,2,-1\n"
               "b.png,2,0,2,0,0,2.5,0\n");
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_TRUE(drive->has_tilts);
  EXPECT_EQ(drive->frames[0].pitch_deg, 2);
  EXPECT_EQ(drive->frames[0].roll_deg, -1);
  EXPECT_EQ(drive->frames[1].pitch_deg, 2.5);
}

TEST(ReadDriveRefuses, AMountingOrATiltThatIsNone) {
  const auto refused = [](const std::string& mounting) {
    const DriveFolder folder;
    folder.replace("drive.json", R"("name")", R"("mounting": )" + mounting + R"(, "name")");
    return refusal(folder);
  };
  EXPECT_THAT(refused("[1, 2, 3]"), HasSubstr("mounting is not an object; "));
  EXPECT_THAT(refused(R"({"forward_mm": 1200})"),
              HasSubstr("mounting.forward_mm is not known; write one of forward_m, right_m, "));
  EXPECT_THAT(refused(R"({"forward_m": 1200})"), HasSubstr("mounting.forward_m is 1200; "));
  EXPECT_THAT(refused(R"({"yaw_deg": 181})"), HasSubstr("mounting.yaw_deg is 181; "));
  const DriveFolder folder;
  folder.write("trajectory.csv",
               "filename,timestamp_s,east_m,north_m,up_m,heading_deg,pitch_deg\n"
               "a.png,1,0,0,0,0,81\n");
  EXPECT_THAT(refusal(folder), HasSubstr("line 2: pitch_deg or roll_deg is out of range; "));
}

}  // namespace
}  // namespace milepost
