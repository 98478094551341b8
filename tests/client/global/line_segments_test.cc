#include "client/global/line_segments.h"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

TEST(LineSegments, ABoxHasFourSidesTheLongestFirst) {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(40));
  cv::rectangle(image, {60, 80}, {259, 159}, cv::Scalar(200), cv::FILLED);
  const auto segments = line_segments(image, 20);
  ASSERT_EQ(segments.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d extent_px = (segments[i].end_px - segments[i].start_px).cwiseAbs();
    const bool is_level = i < 2;  // the long sides
    EXPECT_NEAR(is_level ? extent_px.x() : extent_px.y(), is_level ? 200 : 80, 6);
    EXPECT_NEAR(is_level ? extent_px.y() : extent_px.x(), 0, 0.5);
  }
  EXPECT_EQ(line_segments(image, 120).size(), 2u);
}

TEST(LineSegments, APlainImageHasNone) {
  EXPECT_TRUE(line_segments(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), 20).empty());
}

}  // namespace
}  // namespace milepost
