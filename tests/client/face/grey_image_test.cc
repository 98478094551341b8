#include "client/face/grey_image.h"

#include <gtest/gtest.h>

#include <vector>

namespace milepost::vehicle {
namespace {

Camera camera_of(int width_px, int height_px) {
  Camera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  return camera;
}

TEST(GreyImage, IsAViewOfGreyPixels) {
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 0, 4, 5, 6, 0};  // rows of four bytes
  const auto grey = grey_image({pixels.data(), 3, 2, 4, PixelFormat::gray8}, camera_of(3, 2));
  ASSERT_TRUE(grey.ok());
  EXPECT_EQ(grey->data, pixels.data());
  EXPECT_EQ(grey->at<std::uint8_t>(1, 2), 6);
}

TEST(GreyImage, OrdersOfColoursAreTold) {
  const std::vector<std::uint8_t> red_first = {200, 100, 50};
  const std::vector<std::uint8_t> blue_first = {50, 100, 200};
  const auto rgb = grey_image({red_first.data(), 1, 1, 3, PixelFormat::rgb8}, camera_of(1, 1));
  const auto bgr = grey_image({blue_first.data(), 1, 1, 3, PixelFormat::bgr8}, camera_of(1, 1));
  ASSERT_TRUE(rgb.ok() && bgr.ok());
  EXPECT_NEAR(rgb->at<std::uint8_t>(0, 0), 0.299 * 200 + 0.587 * 100 + 0.114 * 50, 1);
  EXPECT_EQ(rgb->at<std::uint8_t>(0, 0), bgr->at<std::uint8_t>(0, 0));
  const std::vector<std::uint8_t> with_alpha = {50, 100, 200, 7};
  const auto bgra = grey_image({with_alpha.data(), 1, 1, 4, PixelFormat::bgra8}, camera_of(1, 1));
  EXPECT_EQ(bgra->at<std::uint8_t>(0, 0), bgr->at<std::uint8_t>(0, 0));
}

TEST(GreyImage, RefusesWhatIsNoImageOfTheCamera) {
  const std::vector<std::uint8_t> pixels(100, 9);
  const auto refused = [](const ImageView& image) {
    const auto grey = grey_image(image, camera_of(10, 10));
    return !grey.ok() && grey.error().code == ErrorCode::invalid_input;
  };
  EXPECT_TRUE(refused({nullptr, 10, 10, 10, PixelFormat::gray8}));
  EXPECT_TRUE(refused({pixels.data(), 9, 10, 10, PixelFormat::gray8}));
  EXPECT_TRUE(refused({pixels.data(), 10, 11, 10, PixelFormat::gray8}));
  EXPECT_TRUE(refused({pixels.data(), 10, 10, 9, PixelFormat::gray8}));
  EXPECT_TRUE(refused({pixels.data(), 10, 10, -10, PixelFormat::gray8}));
  EXPECT_TRUE(refused({pixels.data(), 10, 10, 10, PixelFormat::rgb8}));
  EXPECT_FALSE(refused({pixels.data(), 10, 10, 10, PixelFormat::gray8}));
}

}  // namespace
}  // namespace milepost::vehicle
