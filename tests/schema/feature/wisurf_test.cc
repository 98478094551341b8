#include "schema/feature/wisurf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace milepost {
namespace {

cv::Mat random_image(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat image(height, width, CV_8UC1);
  int grey = 100;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {  // similar neighbours, as in images
      grey = std::clamp(grey + static_cast<int>(random() % 41) - 20, 0, 255);
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(grey);
    }
  }
  return image;
}

// The definition of wisurf.h, pixel by pixel: each pixel of a wavelet belongs to one half or the
// other along each axis.
ImageDescriptor by_definition(const cv::Mat& image) {
  const double step_x = image.cols / 20.0;
  const double step_y = image.rows / 20.0;
  std::array<double, 64> values{};
  for (int j = 0; j < 20; ++j) {
    for (int i = 0; i < 20; ++i) {
      const double centre_x = (i + 0.5) * step_x;
      const double centre_y = (j + 0.5) * step_y;
      double left = 0, right = 0, upper = 0, lower = 0;
      int lefts = 0, rights = 0, uppers = 0, lowers = 0;
      for (int y = 0; y < image.rows; ++y) {
        if (y < std::lround(centre_y - step_y) || y >= std::lround(centre_y + step_y)) continue;
        for (int x = 0; x < image.cols; ++x) {
          if (x < std::lround(centre_x - step_x) || x >= std::lround(centre_x + step_x)) continue;
          const double grey = image.at<std::uint8_t>(y, x);
          const bool is_right = x >= std::lround(centre_x);
          const bool is_lower = y >= std::lround(centre_y);
          (is_right ? right : left) += grey;
          ++(is_right ? rights : lefts);
          (is_lower ? lower : upper) += grey;
          ++(is_lower ? lowers : uppers);
        }
      }
      const double dx = right / rights - left / lefts;
      const double dy = lower / lowers - upper / uppers;
      const int cell = j / 5 * 4 + i / 5;
      values[4 * cell] += dx;
      values[4 * cell + 1] += dy;
      values[4 * cell + 2] += std::abs(dx);
      values[4 * cell + 3] += std::abs(dy);
    }
  }
  double square = 0;
  for (const double value : values) square += value * value;
  ImageDescriptor descriptor;
  for (std::size_t k = 0; k < 64; ++k) {
    descriptor[k] = static_cast<float>(values[k] / std::sqrt(square));
  }
  return descriptor;
}

TEST(Wisurf, IsItsDefinition) {
  for (const auto& [width, height] :
       {std::pair(120, 100), std::pair(123, 87), std::pair(241, 64)}) {
    const cv::Mat image = random_image(width, height, 3);
    const ImageDescriptor expected = by_definition(image);
    const ImageDescriptor descriptor = wisurf(image);
    for (std::size_t k = 0; k < descriptor.size(); ++k) {
      EXPECT_NEAR(descriptor[k], expected[k], 1e-6) << width << " x " << height << ", value " << k;
    }
  }
}

// Grey increases to the right only: only dx, equal to |dx|.
TEST(Wisurf, ARampIsItsGradientInEveryCell) {
  cv::Mat ramp(100, 200, CV_8UC1);
  for (int x = 0; x < 200; ++x) ramp.col(x) = x;
  const ImageDescriptor descriptor = wisurf(ramp);
  double length = 0;
  for (std::size_t cell = 0; cell < 16; ++cell) {
    EXPECT_GT(descriptor[4 * cell], 0.1);
    EXPECT_EQ(descriptor[4 * cell], descriptor[4 * cell + 2]);
    EXPECT_EQ(descriptor[4 * cell + 1], 0);
    EXPECT_EQ(descriptor[4 * cell + 3], 0);
    length += std::pow(descriptor[4 * cell], 2) + std::pow(descriptor[4 * cell + 2], 2);
  }
  EXPECT_NEAR(length, 1, 1e-5);
  EXPECT_NEAR(descriptor[4 * 5], descriptor[4 * 6], 1e-6);  // inner cells are equal
}

TEST(Wisurf, ContrastAndBrightnessDoNotCount) {
  const cv::Mat image = random_image(160, 120, 5);
  cv::Mat darker;
  image.convertTo(darker, CV_8UC1, 0.5, 20);
  EXPECT_LT(image_distance(wisurf(image), wisurf(darker)), 0.02);
  EXPECT_GT(image_distance(wisurf(image), wisurf(random_image(160, 120, 6))), 0.2);
}

TEST(Wisurf, AnEvenOrATinyImageIsNoError) {
  for (const cv::Size size : {cv::Size(80, 60), cv::Size(1, 1), cv::Size(30, 2)}) {
    const ImageDescriptor descriptor = wisurf(cv::Mat(size, CV_8UC1, cv::Scalar(77)));
    for (const float value : descriptor) EXPECT_TRUE(std::isfinite(value));
  }
  EXPECT_EQ(image_distance(wisurf(cv::Mat(60, 80, CV_8UC1, cv::Scalar(77))), ImageDescriptor{}), 0);
}

TEST(ImageDistance, IsEuclidean) {
  ImageDescriptor a{};
  ImageDescriptor b{};
  a[0] = 0.6F;
  b[63] = 0.8F;
  EXPECT_NEAR(image_distance(a, b), 1, 1e-6);
}

}  // namespace
}  // namespace milepost
