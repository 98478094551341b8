#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "schema/drive/drive.h"
#include "tests/schema/drive/drive_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ReadDrive, GivesWhatTheFolderSays) {
  const DriveFolder folder;
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_EQ(drive->folder, folder.path());
  EXPECT_EQ(drive->name, "north");
  EXPECT_EQ(drive->camera, (Camera{16, 12, {20.5, 21.5, 8, 6.25}}));
  EXPECT_EQ(drive->position_frame, PositionFrame::local);
  EXPECT_EQ(drive->origin, (GeoPoint{49.0, 8.4, 110}));
  EXPECT_EQ(drive->images, "frames");
  EXPECT_EQ(drive->captured, "2011-09-30");
  EXPECT_EQ(drive->licence, "free");
  EXPECT_EQ(drive->source, "a test");
  EXPECT_TRUE(drive->gps.empty());
  EXPECT_TRUE(drive->odometry.empty());
  ASSERT_EQ(drive->frames.size(), 4U);
  EXPECT_EQ(drive->frames[1].filename, "b.png");
  EXPECT_EQ(drive->frames[1].timestamp_s, 10.2);
  EXPECT_EQ(drive->frames[1].line, 3U);
}

TEST(ReadDrive, PlacesLocalPositionsAboutTheOrigin) {
  const DriveFolder folder;
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  const GeoPoint first = drive->frames[0].position;
  EXPECT_NEAR(first.latitude_deg, 49.0, 1e-12);
  EXPECT_NEAR(first.longitude_deg, 8.4, 1e-12);
  EXPECT_NEAR(first.altitude_m, 111.5, 1e-8);
  // Two metres at 111.5 m of altitude are a little less on the ellipsoid: 2 * (1 - 111.5 / 6.38e6).
  EXPECT_NEAR(geodesic_distance_m(first, drive->frames[1].position), 2 - 3.5e-5, 1e-6);
  EXPECT_NEAR(geodesic_azimuth_deg(first, drive->frames[1].position), 0, 1e-6);
}

TEST(ReadDrive, BringsHeadingsIntoOneTurn) {
  const DriveFolder folder;
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_DOUBLE_EQ(drive->frames[0].heading_deg, 359.5);
  EXPECT_DOUBLE_EQ(drive->frames[2].heading_deg, 0);
  EXPECT_DOUBLE_EQ(drive->frames[3].heading_deg, 5);
}

TEST(ReadDrive, TakesGeographicPositionsAsTheyAre) {
  const DriveFolder folder;
  folder.replace("drive.json", R"("local")", R"("geographic")");
  folder.write("trajectory.csv",
               "filename,timestamp_s,latitude_deg,longitude_deg,altitude_m,heading_deg\n"
               "a.png,1,49.01,8.43,114,344\n"
               "b.png,2,49.0101,8.43,115,344\n");
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_EQ(drive->origin, std::nullopt);
  EXPECT_EQ(drive->frames[1].position, (GeoPoint{49.0101, 8.43, 115}));
}

TEST(ReadDrive, ReadsReceiverAndOdometer) {
  const DriveFolder folder;
  folder.write("gps.csv", "timestamp_s,latitude_deg,longitude_deg,sigma_m\n10,49.001,8.401,5\n");
  folder.write("odometry.csv", "timestamp_s,speed_mps,yaw_rate_dps\n10,9.5,-3\n10.1,9.6,-2\n");
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  ASSERT_EQ(drive->gps.size(), 1U);
  EXPECT_EQ(drive->gps[0].position, (GeoPoint{49.001, 8.401, 0}));
  EXPECT_EQ(drive->gps[0].sigma_m, 5);
  ASSERT_EQ(drive->odometry.size(), 2U);
  EXPECT_EQ(drive->odometry[1].speed_mps, 9.6);
  EXPECT_EQ(drive->odometry[1].yaw_rate_dps, -2);
}

TEST(ReadDrive, ReadsWhatIsStatedOfItsPositions) {
  const DriveFolder folder;
  EXPECT_EQ(read_drive(folder.path())->position_error.sigma_m, std::nullopt);
  EXPECT_EQ(read_drive(folder.path())->frames[0].position_sigma_m, std::nullopt);
  folder.replace("drive.json", R"("name")",
                 R"("position_sigma_m": 0.05, "position_correlation_m": 80,
                    "position_group": "receiver 7", "name")");
  folder.write("trajectory.csv",
               "filename,timestamp_s,east_m,north_m,up_m,heading_deg,lane,position_sigma_m\n"
               "a.png,1,0,0,0,0,left,0.02\n"
               "b.png,2,0,2,0,0,left,0\n");
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_EQ(drive->position_error.sigma_m, 0.05);
  EXPECT_EQ(drive->position_error.correlation_m, 80);
  EXPECT_EQ(drive->position_error.group, "receiver 7");
  EXPECT_EQ(drive->frames[0].position_sigma_m, 0.02);
  EXPECT_EQ(drive->frames[1].position_sigma_m, 0);
}

TEST(ReadDriveRefuses, TimesInAnotherUnit) {
  for (const auto& [factor, unit] : {std::pair{"000", "milliseconds"},
                                     {"000000", "microseconds"},
                                     {"000000000", "nanoseconds"}}) {
    const DriveFolder folder;
    std::string gps = "timestamp_s,latitude_deg,longitude_deg,sigma_m\n";
    for (const char* second : {"10", "11", "12", "13", "14"})
      gps += std::string(second) + factor + ",49,8.4,5\n";
    folder.write("gps.csv", gps);
    EXPECT_THAT(refusal(folder),
                HasSubstr(std::string("as of times in ") + unit + "; give timestamp_s in seconds"));
  }
}

TEST(ReadDriveRefuses, ASigmaOfAFrameThatIsNone) {
  const DriveFolder folder;
  const std::string columns =
      "filename,timestamp_s,east_m,north_m,up_m,heading_deg,position_sigma_m\n";
  folder.write("trajectory.csv", columns + "a.png,1,0,0,0,0,0.02\nb.png,2,0,2,0,0,-0.1\n");
  EXPECT_THAT(refusal(folder), HasSubstr("line 3: position_sigma_m is -0.1; "));
  folder.write("trajectory.csv", columns + "a.png,1,0,0,0,0,\nb.png,2,0,2,0,0,1\n");
  EXPECT_THAT(refusal(folder), HasSubstr("line 2: position_sigma_m is '', not a finite number; "));
}

TEST(ReadDrive, CountsLinesAsAnEditorDoes) {
  const DriveFolder folder;
  folder.replace_line("trajectory.csv", 3, "\nb.png,10.0,0,2,1.5,0");
  EXPECT_THAT(refusal(folder), StartsWith(folder.file("trajectory.csv") + ", line 4: "));
}

// Files that are not there

TEST(ReadDriveRefuses, AFolderThatIsMissing) {
  const Result<Drive> drive = read_drive("no-such-drive");
  ASSERT_FALSE(drive.ok());
  EXPECT_EQ(drive.error().code, ErrorCode::not_found);
  EXPECT_THAT(drive.error().line(), StartsWith("no-such-drive/drive.json: there is no such file"));
}

TEST(ReadDriveRefuses, AMissingTrajectory) {
  const DriveFolder folder;
  std::filesystem::remove(folder.path() / "trajectory.csv");
  EXPECT_THAT(refusal(folder),
              StartsWith(folder.file("trajectory.csv") + ": there is no such file"));
}

TEST(ReadDriveRefuses, AMissingImage) {
  const DriveFolder folder;
  std::filesystem::remove(folder.path() / "frames" / "c.png");
  EXPECT_EQ(refusal(folder), folder.file("trajectory.csv") + ", line 4: there is no image " +
                                 folder.file("frames/c.png") + "; add the image or remove the row");
}

TEST(ReadDriveRefuses, AFolderInPlaceOfAnImage) {
  const DriveFolder folder;
  std::filesystem::remove(folder.path() / "frames" / "c.png");
  std::filesystem::create_directory(folder.path() / "frames" / "c.png");
  EXPECT_THAT(refusal(folder), HasSubstr("line 4: there is no image"));
}

// drive.json

struct BadDescription {
  std::string old_text, new_text, message;
};

class BadDescriptions : public ::testing::TestWithParam<BadDescription> {};

TEST_P(BadDescriptions, AreRefused) {
  const DriveFolder folder;
  folder.replace("drive.json", GetParam().old_text, GetParam().new_text);
  EXPECT_THAT(refusal(folder), StartsWith(folder.file("drive.json") + ": " + GetParam().message));
}

const BadDescription kBadDescriptions[] = {
    {R"("name": "north",)", "", "name is missing; "},
    {R"("north")", "7", "name is not a string; "},
    {R"("camera": {)", R"("camera": 5, "other": {)", "camera is not an object; "},
    {R"("width_px": 16, )", "", "camera.width_px is missing; "},
    {R"("height_px": 12)", R"("height_px": 12.5)", "camera.height_px is not a whole number; "},
    {R"("width_px": 16)", R"("width_px": 0)", "camera.width_px is 0; "},
    {R"("width_px": 16)", R"("width_px": 20001)", "camera.width_px is 20001; "},
    {R"("height_px": 12)", R"("height_px": -12)", "camera.height_px is -12; "},
    {R"("height_px": 12)", R"("height_px": 99999999999)", "camera.height_px is "},
    {"[20.5, 21.5]", "20.5", "camera.focal_px is not two numbers; "},
    {"[20.5, 21.5]", "[20.5]", "camera.focal_px is not two numbers; "},
    {"[20.5, 21.5]", "[20.5, 21.5, 1]", "camera.focal_px is not two numbers; "},
    {"[20.5, 21.5]", R"([20.5, "x"])", "camera.focal_px is not two numbers; "},
    {"[20.5, 21.5]", "[20.5, 0]", "camera.focal_px holds 0; "},
    {"[20.5, 21.5]", "[-20.5, 21.5]", "camera.focal_px holds -20.5; "},
    {R"("principal_px")", R"("principle_px")",
     "camera.principle_px is not known; write one of width_px, "},
    {R"("frame": "local",)", "", "frame is missing; "},
    {R"("local")", R"("utm")", "frame is 'utm', neither 'local' nor 'geographic'; "},
    {R"("origin")", R"("start")", "origin is missing; "},
    {R"("longitude_deg": 8.4, )", "", "origin.longitude_deg is missing; "},
    {R"("altitude_m": 110)", R"("altitude_m": "110")", "origin.altitude_m is not a number; "},
    {"49.0", "90.5", "origin is not a position"},
    {R"("images": "frames",)", "", "images is missing; "},
    {R"("frames")", R"("../frames")", "images is '../frames', not a folder inside the drive; "},
    {R"("frames")", R"("/frames")", "images is '/frames', not a folder inside the drive; "},
    {R"("frames")", R"("")", "images is '', not a folder inside the drive; "},
    {R"("free")", "[]", "licence is not a string; "},
    {R"("name")", R"("position_sigma_m": "x", "name")", "position_sigma_m is not a number; "},
    {R"("name")", R"("position_sigma_m": -1, "name")", "position_sigma_m is -1; "},
    {R"("name")", R"("position_sigma_m": 1001, "name")", "position_sigma_m is 1001; "},
    {R"("name")", R"("position_correlation_m": 0, "name")", "position_correlation_m is 0; "},
    {R"("name")", R"("position_group": 7, "name")", "position_group is not a string; "},
};

INSTANTIATE_TEST_SUITE_P(ReadDrive, BadDescriptions, ::testing::ValuesIn(kBadDescriptions));

TEST(ReadDriveRefuses, ADescriptionThatIsNoObject) {
  const DriveFolder folder;
  folder.write("drive.json", "[1, 2]");
  EXPECT_THAT(refusal(folder), StartsWith(folder.file("drive.json") + ": is not a JSON object"));
}

TEST(ReadDriveRefuses, ADescriptionThatIsNotJsonByItsPlace) {
  const DriveFolder folder;
  folder.replace("drive.json", R"("north",)", R"("north")");
  EXPECT_THAT(refusal(folder),
              StartsWith(folder.file("drive.json") + ", byte 30: this is not JSON " +
                         "(parse error at line 3, column 10: "));
}

TEST(ReadDriveRefuses, ANumberBeyondADouble) {
  const DriveFolder folder;
  folder.replace("drive.json", R"("fair")", "1e999");
  EXPECT_THAT(refusal(folder), HasSubstr("this is not JSON (number overflow parsing '1e999'"));
}

TEST(ReadDriveRefuses, AnEmptyDescription) {
  const DriveFolder folder;
  folder.write("drive.json", "");
  EXPECT_THAT(refusal(folder),
              StartsWith(folder.file("drive.json") + ", byte 1: this is not JSON (parse error"));
}

TEST(ReadDriveRefuses, ADescriptionThatIsNestedDeep) {
  const DriveFolder folder;
  folder.write("drive.json",
               R"({"name": )" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
  EXPECT_THAT(refusal(folder),
              StartsWith(folder.file("drive.json") + ": it is nested more than 32 deep"));
}

// trajectory.csv; each case replaces one line

struct BadRow {
  std::size_t line;
  std::string text;
  std::string message;  // after "trajectory.csv, line N: "
};

class BadRows : public ::testing::TestWithParam<BadRow> {};

TEST_P(BadRows, AreRefused) {
  const DriveFolder folder;
  const auto& [line, text, message] = GetParam();
  folder.replace_line("trajectory.csv", line, text);
  EXPECT_THAT(refusal(folder), StartsWith(folder.file("trajectory.csv") + ", line " +
                                          std::to_string(line) + ": " + message));
}

const BadRow kBadRows[] = {
    {1, "filename,timestamp_s,latitude_deg,longitude_deg,altitude_m,heading_deg",
     "column 3 is 'latitude_deg', expected 'east_m'"},
    {3, "b.png,10.2,0,2", "the row has 4 cells"},
    {3, "b.png,10.2,0,nan,1.5,0", "north_m is 'nan', not a finite number"},
    {3, "b.png,inf,0,2,1.5,0", "timestamp_s is 'inf', not a finite number"},
    {3, "b.png,10.2,0,2,1.5,north", "heading_deg is 'north', not a finite number"},
    {3, "b.png,10.2,0,2000000,1.5,0", "the position lies 1000 km or more from the origin"},
    {4, "c.png,10.2,0,4,1.5,0", "timestamp_s 10.2 is not later than 10.2 on line 3; "},
    {4, "c.png,9.5,0,4,1.5,0", "timestamp_s 9.5 is not later than 10.2 on line 3; "},
    {4, "b.png,10.4,0,4,1.5,0", "filename 'b.png' is already on line 3; "},
    {3, ",10.2,0,2,1.5,0", "filename '' is not the plain name of a file; "},
    {3, "..,10.2,0,2,1.5,0", "filename '..' is not the plain name of a file; "},
    {3, "../b.png,10.2,0,2,1.5,0", "filename '../b.png' is not the plain name of a file; "},
    {3, "/b.png,10.2,0,2,1.5,0", "filename '/b.png' is not the plain name of a file; "},
    {3, R"(x\b.png,10.2,0,2,1.5,0)", R"(filename 'x\b.png' is not the plain name of a file; )"},
};

INSTANTIATE_TEST_SUITE_P(ReadDrive, BadRows, ::testing::ValuesIn(kBadRows));

TEST(ReadDriveRefuses, APositionJump) {
  const DriveFolder folder;
  folder.replace_line("trajectory.csv", 5, "d.png,10.9,0,54,1.5,0");
  EXPECT_EQ(refusal(folder), folder.file("trajectory.csv") +
                                 ", line 5: the position jumps 50.0 m from line 4 in 0.500 s: "
                                 "100.0 m/s, faster than 70; correct the positions or the times, "
                                 "or split the drive there");
}

TEST(ReadDrive, AcceptsAFastCar) {
  const DriveFolder folder;
  folder.replace_line("trajectory.csv", 5, "d.png,10.6,0,17.9,1.5,0");  // 13.9 m in 0.2 s
  EXPECT_EQ(refusal(folder), "accepted");
}

TEST(ReadDriveRefuses, AJumpOfAltitude) {
  const DriveFolder folder;
  folder.replace_line("trajectory.csv", 5, "d.png,10.6,0,6,101.5,0");
  EXPECT_THAT(refusal(folder), HasSubstr("line 5: the position jumps 100.0 m from line 4"));
}

TEST(ReadDriveRefuses, ATrajectoryWithoutRows) {
  const DriveFolder folder;
  folder.write("trajectory.csv", "filename,timestamp_s,east_m,north_m,up_m,heading_deg\n");
  EXPECT_THAT(refusal(folder), StartsWith(folder.file("trajectory.csv") + ": there is no frame; "));
}

TEST(ReadDriveRefuses, PositionsOffTheEarth) {
  const DriveFolder folder;
  folder.replace("drive.json", R"("local")", R"("geographic")");
  const std::string header =
      "filename,timestamp_s,latitude_deg,longitude_deg,altitude_m,heading_deg\n";
  folder.write("trajectory.csv", header + "a.png,1,90.1,8.4,0,0\n");
  EXPECT_THAT(refusal(folder),
              HasSubstr("trajectory.csv, line 2: latitude_deg 90.1 is out of range"));
  folder.write("trajectory.csv", header + "a.png,1,49,-181,0,0\n");
  EXPECT_THAT(refusal(folder),
              HasSubstr("trajectory.csv, line 2: longitude_deg -181 is out of range"));
}

// gps.csv and odometry.csv

struct BadReading {
  std::string name, content;
  std::size_t line;
  std::string message;
};

class BadReadings : public ::testing::TestWithParam<BadReading> {};

TEST_P(BadReadings, AreRefused) {
  const DriveFolder folder;
  folder.write(GetParam().name, GetParam().content);
  EXPECT_THAT(refusal(folder),
              StartsWith(folder.file(GetParam().name) + ", line " +
                         std::to_string(GetParam().line) + ": " + GetParam().message));
}

const std::string kGpsHeader = "timestamp_s,latitude_deg,longitude_deg,sigma_m\n";
const std::string kOdometryHeader = "timestamp_s,speed_mps,yaw_rate_dps\n";
const BadReading kBadReadings[] = {
    {"gps.csv", "timestamp_s,latitude_deg\n", 1, "column 3 is missing, expected 'longitude_deg'"},
    {"gps.csv", kGpsHeader + "1,49,8,0\n", 2, "sigma_m is 0; "},
    {"gps.csv", kGpsHeader + "1,49,8,-5\n", 2, "sigma_m is -5; "},
    {"gps.csv", kGpsHeader + "1,49,8,nan\n", 2, "sigma_m is 'nan', not a finite number"},
    {"gps.csv", kGpsHeader + "1,91,8,5\n", 2, "latitude_deg 91 is out of range"},
    {"gps.csv", kGpsHeader + "1,49,8,5\n1,49,8,5\n", 3,
     "timestamp_s 1 is not later than 1 on line 2"},
    {"odometry.csv", "time,speed_mps,yaw_rate_dps\n", 1,
     "column 1 is 'time', expected 'timestamp_s'"},
    {"odometry.csv", kOdometryHeader + "1,fast,0\n", 2, "speed_mps is 'fast', not a finite number"},
    {"odometry.csv", kOdometryHeader + "1,5,0\n0.5,5,0\n", 3,
     "timestamp_s 0.5 is not later than 1 on line 2"},
};

INSTANTIATE_TEST_SUITE_P(ReadDrive, BadReadings, ::testing::ValuesIn(kBadReadings));

}  // namespace
}  // namespace milepost
