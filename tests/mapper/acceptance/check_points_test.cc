#include "mapper/acceptance/check_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

Drive drive(const std::string& name) {
  Drive made;
  made.name = name;
  made.camera.width_px = 640;
  made.camera.height_px = 480;
  made.frames.resize(2);
  made.frames[0].filename = "0.png";
  made.frames[1].filename = "1.png";
  return made;
}

class CheckPointsTest : public ::testing::Test {
 protected:
  Result<std::vector<CheckPoint>> read(const std::string& text, const std::string& crs = "",
                                       const Datum& datum = {}) const {
    std::ofstream(folder_ / "marks.csv") << text;
    return read_check_points(folder_ / "marks.csv", crs, datum, drives_);
  }
  std::string error(const std::string& text, const std::string& crs = "",
                    const Datum& datum = {}) const {
    const auto points = read(text, crs, datum);
    return points ? "" : points.error().line();
  }

  testing::TempFolder folder_;
  std::vector<Drive> drives_ = {drive("monday"), drive("tuesday")};
};

constexpr const char* kHeader =
    "mark,latitude_deg,longitude_deg,altitude_m,drive,filename,x_px,y_px\n";

TEST_F(CheckPointsTest, RowsOfAMarkAreItsSights) {
  const auto points = read(std::string(kHeader) +
                           "A,49,8.4,120,monday,0.png,10,20\nB,49.1,8.4,121,monday,0.png,1,2\n"
                           "A,49,8.4,120,tuesday,1.png,30.5,40\n");
  ASSERT_TRUE(points.ok()) << points.error().line();
  ASSERT_EQ(points->size(), 2U);
  const CheckPoint& a = points->front();
  EXPECT_EQ(a.mark, "A");
  EXPECT_EQ(a.position.latitude_deg, 49);
  EXPECT_EQ(a.position.longitude_deg, 8.4);
  EXPECT_EQ(a.position.altitude_m, 120);
  ASSERT_EQ(a.sights.size(), 2U);
  EXPECT_EQ(a.sights[1].drive, "tuesday");
  EXPECT_EQ(a.sights[1].filename, "1.png");
  EXPECT_EQ(a.sights[1].image_px, Eigen::Vector2d(30.5, 40));
}

TEST_F(CheckPointsTest, MarksOfAnotherSystemAreTransformed) {
  drives_.pop_back();
  const std::string text = "mark,x,y,z,filename,x_px,y_px\nA,500000,0,12,0.png,1,2\n";
  const auto own = read(text, "EPSG:25832");
  ASSERT_TRUE(own.ok()) << own.error().line();
  EXPECT_NEAR(own->front().position.longitude_deg, 9, 1e-9);
  EXPECT_NEAR(own->front().position.altitude_m, 12, 1e-6);
  // Where the map is of another datum the marks are moved to it.
  const std::string karlsruhe = "mark,x,y,z,filename,x_px,y_px\nA,456000,5427600,120,0.png,1,2\n";
  const auto here = read(karlsruhe, "EPSG:25832");
  const auto there = read(karlsruhe, "EPSG:25832", *Datum::from("ITRF2014@2020.5"));
  ASSERT_TRUE(there.ok()) << there.error().line();
  EXPECT_NEAR(geodesic_distance_m(here->front().position, there->front().position), 0.8, 0.05);
  EXPECT_THAT(error(text, "EPSG:25832", *Datum::from("ITRF2014")), HasSubstr("needs an epoch"));
  EXPECT_THAT(error(text, "EPSG:1"), HasSubstr("--check-crs"));
}

TEST_F(CheckPointsTest, WhatIsWrongIsNamedByItsLine) {
  const std::string header = kHeader;
  const std::string row = "A,49,8.4,120,monday,0.png,10,20\n";
  EXPECT_THAT(error(header), HasSubstr("holds no mark"));
  EXPECT_THAT(error("mark,x,y,z\n"), HasSubstr("no column 'filename'"));
  EXPECT_THAT(error(header + row + "A,49.001,8.4,120,monday,1.png,10,20\n"),
              HasSubstr("marks.csv, line 3: mark 'A' has another position"));
  EXPECT_THAT(error(header + "A,49,8.4,120,sunday,0.png,10,20\n"),
              HasSubstr("line 2: there is no drive 'sunday'"));
  EXPECT_THAT(error(header + "A,49,8.4,120,monday,7.png,10,20\n"), HasSubstr("no frame '7.png'"));
  EXPECT_THAT(error(header + "A,49,8.4,120,monday,0.png,640,20\n"), HasSubstr("beside the image"));
  EXPECT_THAT(error(header + "A,95,8.4,120,monday,0.png,10,20\n"), HasSubstr("no position"));
  EXPECT_THAT(error(header + "A,49,8.4,high,monday,0.png,10,20\n"), HasSubstr("line 2"));
  EXPECT_THAT(error("mark,latitude_deg,longitude_deg,altitude_m,filename,x_px,y_px\n"
                    "A,49,8.4,120,0.png,10,20\n"),
              HasSubstr("add the column drive"));
}

}  // namespace
}  // namespace milepost
