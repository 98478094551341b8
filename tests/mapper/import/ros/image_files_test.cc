#include "mapper/import/ros/image_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <opencv2/imgcodecs.hpp>

namespace milepost::ros {
namespace {

using ::testing::HasSubstr;

// An image of pixels of some bytes each, with two bytes more in each row.
class Pixels {
 public:
  Pixels(std::string encoding, std::uint32_t width_px, std::uint32_t height_px,
         std::uint32_t pixel_bytes)
      : encoding_(std::move(encoding)),
        bytes_(std::size_t{height_px} * (width_px * pixel_bytes + 2)) {
    image_.width_px = width_px;
    image_.height_px = height_px;
    image_.row_bytes = width_px * pixel_bytes + 2;
  }
  std::uint8_t& at(std::uint32_t row, std::uint32_t byte) {
    return bytes_[row * image_.row_bytes + byte];
  }
  Image image() const {
    Image image = image_;
    image.encoding = encoding_;
    image.pixels = bytes_;
    return image;
  }
  cv::Mat decoded() const {
    const auto png = png_of(image());
    EXPECT_TRUE(png.ok()) << png.error().line();
    return png ? cv::imdecode(*png, cv::IMREAD_UNCHANGED) : cv::Mat();
  }

  Image image_;

 private:
  std::string encoding_;
  Bytes bytes_;
};

TEST(PngOf, GreyIsAsItIs) {
  for (const char* const encoding : {"mono8", "8UC1"}) {
    Pixels pixels(encoding, 3, 2, 1);
    pixels.at(1, 2) = 200;
    const cv::Mat decoded = pixels.decoded();
    ASSERT_EQ(decoded.type(), CV_8UC1);
    ASSERT_EQ(decoded.size(), cv::Size(3, 2));
    EXPECT_EQ(decoded.at<std::uint8_t>(1, 2), 200);
    EXPECT_EQ(decoded.at<std::uint8_t>(0, 2), 0);
  }
}

TEST(PngOf, GreyOf16BitsInBothByteOrders) {
  for (const bool is_big_endian : {false, true}) {
    Pixels pixels("mono16", 3, 2, 2);
    pixels.image_.is_big_endian = is_big_endian;
    pixels.at(1, 4) = is_big_endian ? 0x12 : 0x34;
    pixels.at(1, 5) = is_big_endian ? 0x34 : 0x12;
    const cv::Mat decoded = pixels.decoded();
    ASSERT_EQ(decoded.type(), CV_16UC1);
    EXPECT_EQ(decoded.at<std::uint16_t>(1, 2), 0x1234);
  }
}

TEST(PngOf, ColoursInEachOrder) {
  for (const std::string order : {"rgb", "bgr", "rgba", "bgra"}) {
    Pixels pixels(order + "8", 3, 2, static_cast<std::uint32_t>(order.size()));
    for (std::uint32_t i = 0; i < order.size(); ++i)
      pixels.at(1, static_cast<std::uint32_t>(order.size()) + i) =
          static_cast<std::uint8_t>(order[i]);
    const cv::Mat decoded = pixels.decoded();
    ASSERT_EQ(decoded.type(), CV_8UC3) << order;
    EXPECT_EQ(decoded.at<cv::Vec3b>(1, 1), cv::Vec3b('b', 'g', 'r')) << order;
  }
}

// One colour everywhere: rows of the pattern's first two and its last two letters.
TEST(PngOf, BayerPatterns) {
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    for (const std::uint32_t bytes : {1U, 2U}) {
      Pixels pixels("bayer_" + pattern + (bytes == 1 ? "8" : "16"), 8, 6, bytes);
      for (std::uint32_t row = 0; row < 6; ++row)
        for (std::uint32_t column = 0; column < 8; ++column)
          pixels.at(row, bytes * column + bytes - 1) =
              static_cast<std::uint8_t>(pattern[2 * (row % 2) + column % 2]);
      const cv::Mat decoded = pixels.decoded();
      if (bytes == 1) {
        ASSERT_EQ(decoded.type(), CV_8UC3) << pattern;
        EXPECT_EQ(decoded.at<cv::Vec3b>(3, 4), cv::Vec3b('b', 'g', 'r')) << pattern;
      } else {
        ASSERT_EQ(decoded.type(), CV_16UC3) << pattern;
        EXPECT_EQ(decoded.at<cv::Vec3w>(3, 4), cv::Vec3w('b' << 8, 'g' << 8, 'r' << 8)) << pattern;
      }
    }
  }
}

std::string refusal_of(const Image& image) {
  const auto png = png_of(image);
  return png ? "accepted" : png.error().line();
}

TEST(PngOf, NamesAnUnknownEncoding) {
  EXPECT_THAT(
      refusal_of(Pixels("yuv422", 4, 4, 2).image()),
      HasSubstr("has the encoding 'yuv422', which is not read; convert the topic to mono8"));
}

TEST(PngOf, RefusesMissingPixels) {
  const Pixels pixels("rgb8", 4, 3, 3);
  Image image = pixels.image();
  image.pixels = image.pixels.first(image.pixels.size() - 2);  // the last row's end
  EXPECT_EQ(refusal_of(image), "accepted");
  image.pixels = image.pixels.first(image.pixels.size() - 1);
  EXPECT_THAT(refusal_of(image),
              HasSubstr("has 39 bytes of pixels in rows of 14, not 4 x 3 of rgb8"));
  image = pixels.image();
  image.row_bytes = 11;
  EXPECT_THAT(refusal_of(image), HasSubstr("in rows of 11"));
  for (const std::uint32_t side : {0U, 4'000'000'000U}) {
    image = pixels.image();
    image.height_px = side;
    EXPECT_THAT(refusal_of(image), HasSubstr(" bytes of pixels")) << side;
    image.width_px = side;
    EXPECT_THAT(refusal_of(image), HasSubstr(" bytes of pixels")) << side;
  }
}

TEST(EndingOf, IsThatOfTheBytes) {
  const auto ending = [](std::string_view bytes) {
    CompressedImage image;
    image.format = "rgb8; jpeg compressed bgr8";
    image.file = as_bytes(bytes);
    const auto found = ending_of(image);
    return found ? *found : found.error().line();
  };
  EXPECT_EQ(ending("\xff\xd8\xff\xe0"), ".jpg");
  EXPECT_EQ(ending("\x89PNG\r\n\x1a\n"), ".png");
  EXPECT_EQ(ending(std::string_view("II*\0", 4)), ".tif");
  EXPECT_EQ(ending("RIFFxxxxWEBPVP8 "), ".webp");
  for (const char* const other : {"", "\xff", "RIFFxxxxWAVE"})
    EXPECT_THAT(ending(other), HasSubstr("has the format 'rgb8; jpeg compressed bgr8', whose"));
}

}  // namespace
}  // namespace milepost::ros
