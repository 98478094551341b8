// Background images of a report's plans, read from real files.
#include "client/evaluate/report/backdrop.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

#include "schema/base/file.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

// 2000 x 1000 pixels of a hundred-thousandth of a degree.
constexpr const char* kWorld = "0.00001\n0\n0\n-0.00001\n8.400005\n48.999995\n";

class BackdropTest : public ::testing::Test {
 protected:
  std::filesystem::path picture(const std::string& name, const std::string& world_name,
                                const std::string& world) const {
    EXPECT_TRUE(cv::imwrite((folder_ / name).string(), cv::Mat(1000, 2000, CV_8UC3)));
    EXPECT_TRUE(write_text_file(folder_ / world_name, world).ok());
    return folder_ / name;
  }

  // Expects that reading fails with an error line that contains each part.
  static void expect_refused(const std::filesystem::path& image, ErrorCode code,
                             const std::vector<std::string>& parts) {
    const Result<Backdrop> backdrop = read_backdrop(image);
    ASSERT_FALSE(backdrop.ok());
    EXPECT_EQ(backdrop.error().code, code);
    const std::string line = backdrop.error().line();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    for (const std::string& part : parts) EXPECT_THAT(line, HasSubstr(part));
  }

  testing::TempFolder folder_;
};

TEST_F(BackdropTest, LiesWhereItsWorldFileSaysAndFitsAPage) {
  const Result<Backdrop> backdrop = read_backdrop(picture("town.png", "town.wld", kWorld));
  ASSERT_TRUE(backdrop.ok()) << backdrop.error().line();
  const Bounds box = backdrop->bounds();
  EXPECT_NEAR(box.west_deg, 8.4, 1e-9);
  EXPECT_NEAR(box.east_deg, 8.42, 1e-9);
  EXPECT_NEAR(box.north_deg, 49, 1e-9);
  EXPECT_NEAR(box.south_deg, 48.99, 1e-9);
  const std::optional<PagePicture> page = page_picture(*backdrop, {8, 48, 9, 50});
  ASSERT_TRUE(page);
  EXPECT_NEAR(page->top_left.longitude_deg, 8.4, 1e-9);
  EXPECT_NEAR(page->bottom_left.latitude_deg, 48.99, 1e-9);
  const cv::Mat small = cv::imdecode(page->jpeg, cv::IMREAD_COLOR);
  EXPECT_EQ(small.cols, 1600);
  EXPECT_EQ(small.rows, 800);
}

TEST(PagePicture, IsThePartThatIsShownAtFullResolution) {
  Backdrop backdrop{cv::Mat(1000, 2000, CV_8UC3, cv::Scalar(0, 0, 0)),
                    {1e-5, 0, 0, -1e-5, 8.400005, 48.999995}};
  backdrop.bgr(cv::Rect(1500, 600, 100, 50)).setTo(cv::Scalar(200, 200, 200));
  // Less than one pixel inside the light part on each side.
  const std::optional<PagePicture> page =
      page_picture(backdrop, {8.4150025, 48.9935075, 8.4159975, 48.9939975});
  ASSERT_TRUE(page);
  EXPECT_NEAR(page->top_left.longitude_deg, 8.415, 1e-9);
  EXPECT_NEAR(page->top_left.latitude_deg, 48.994, 1e-9);
  EXPECT_NEAR(page->top_right.longitude_deg, 8.416, 1e-9);
  EXPECT_NEAR(page->top_right.latitude_deg, 48.994, 1e-9);
  EXPECT_NEAR(page->bottom_left.longitude_deg, 8.415, 1e-9);
  EXPECT_NEAR(page->bottom_left.latitude_deg, 48.9935, 1e-9);
  const cv::Mat shown = cv::imdecode(page->jpeg, cv::IMREAD_GRAYSCALE);
  EXPECT_EQ(shown.size(), cv::Size(100, 50));
  double darkest = 0;
  cv::minMaxLoc(shown, &darkest);
  EXPECT_GT(darkest, 190);
}

TEST(PagePicture, IsNearlyGrey) {
  const Backdrop red{cv::Mat(16, 16, CV_8UC3, cv::Scalar(0, 0, 200)), {1e-5, 0, 0, -1e-5, 8.4, 49}};
  const std::optional<PagePicture> page = page_picture(red, red.bounds());
  ASSERT_TRUE(page);
  const cv::Vec3b pixel = cv::imdecode(page->jpeg, cv::IMREAD_COLOR).at<cv::Vec3b>(8, 8);
  EXPECT_NEAR(pixel[2] - pixel[0], 40, 8);  // a fifth of the original
  EXPECT_NEAR(pixel[0], 48, 8);             // four fifths of the share of red in grey
}

TEST(PagePicture, ThereIsNoneOfABoxOutside) {
  const Backdrop backdrop{cv::Mat(10, 10, CV_8UC3, cv::Scalar(0, 0, 0)),
                          {1e-5, 0, 0, -1e-5, 8.4, 49}};
  EXPECT_FALSE(page_picture(backdrop, {9, 49, 9.1, 49.1}));
  EXPECT_FALSE(page_picture(backdrop, {8.4, -60, 8.5, -59}));
  EXPECT_FALSE(page_picture(backdrop, {-170, 49, -169, 49.1}));
}

TEST(WorldFile, FindsThePixelOfATurnedPicture) {
  const WorldFile turned{8e-6, 6e-6, 7e-6, -9e-6, 8.4, 49};
  const GeoPoint place = turned.at({320.25, 77.5});
  const cv::Point2d pixel = turned.project(place.latitude_deg, place.longitude_deg);
  EXPECT_NEAR(pixel.x, 320.25, 1e-6);
  EXPECT_NEAR(pixel.y, 77.5, 1e-6);
}

TEST_F(BackdropTest, TheUsualEndingsOfWorldFilesAreKnown) {
  for (const auto& [image, world] :
       {std::pair("a.png", "a.pgw"), std::pair("b.jpg", "b.jgw"), std::pair("c.jpeg", "c.jgw")}) {
    EXPECT_TRUE(read_backdrop(picture(image, world, kWorld)).ok()) << image;
  }
}

TEST_F(BackdropTest, AWrongLineOfAWorldFileIsNamed) {
  expect_refused(picture("a.png", "a.wld", "0.00001\n0\nnorth\n-0.00001\n8.4\n49\n"),
                 ErrorCode::invalid_input, {"a.wld, line 3", "'north' is not a number"});
  expect_refused(picture("b.png", "b.wld", "0.00001\n0\n0\n-0.00001\n8.4\n"),
                 ErrorCode::invalid_input, {"b.wld, line 6", "six lines"});
  expect_refused(picture("c.png", "c.wld", "0.00001\n0\n0\nnan\n8.4\n49\n"),
                 ErrorCode::invalid_input, {"c.wld, line 4", "'nan'"});
}

TEST_F(BackdropTest, MetresAreNoDegrees) {
  expect_refused(picture("a.png", "a.wld", "0.1\n0\n0\n-0.1\n456000\n5428000\n"),
                 ErrorCode::invalid_input, {"a.wld", "lines 5 and 6", "EPSG:4326"});
  expect_refused(picture("b.png", "b.wld", "0\n0\n0\n0\n8.4\n49\n"), ErrorCode::invalid_input,
                 {"b.wld", "lines 1 to 4"});
}

TEST_F(BackdropTest, WhatIsMissingOrBrokenIsNamed) {
  expect_refused(folder_ / "none.png", ErrorCode::not_found, {"none.png"});
  const auto image = picture("a.png", "a.wld", kWorld);
  std::filesystem::remove(folder_ / "a.wld");
  expect_refused(image, ErrorCode::not_found,
                 {"a.png", "no world file", ".wld", ".pgw", "EPSG:4326"});
  EXPECT_TRUE(write_text_file(folder_ / "text.png", "no picture").ok());
  expect_refused(folder_ / "text.png", ErrorCode::invalid_input, {"text.png", "decoded"});
  const std::string whole = *read_text_file(image);
  EXPECT_TRUE(write_text_file(image, whole.substr(0, whole.size() / 2)).ok());
  expect_refused(image, ErrorCode::invalid_input, {"a.png", "truncated"});
}

}  // namespace
}  // namespace milepost
