// Detection of incomplete images, without output of the decoders.
#include "schema/drive/image_bytes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "schema/drive/image_decode.h"

namespace milepost {
namespace {

constexpr std::string_view kEndMarker("\xff\xd9", 2);

cv::Mat picture(int width_px, int height_px) {
  cv::Mat image(height_px, width_px, CV_8UC3);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(image, image, {}, 1.5);
  return image;
}

std::string encoded(const std::string& extension, const std::vector<int>& parameters = {},
                    const cv::Mat& image = picture(64, 48)) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

// Every kind of JPEG that cameras write.
std::vector<std::string> jpegs() {
  return {encoded(".jpg"), encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1}),
          encoded(".jpg", {cv::IMWRITE_JPEG_RST_INTERVAL, 2}),
          encoded(".jpg", {cv::IMWRITE_JPEG_OPTIMIZE, 1}), encoded(".jpg", {}, picture(61, 43))};
}

cv::Mat plainly_decoded(const std::string& bytes) {
  return cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_GRAYSCALE);
}

// The gray image, or nothing; checks that nothing is written to standard error.
class ImageBytes : public ::testing::Test {
 protected:
  static std::string verdict(const std::string& bytes) {
    ::testing::internal::CaptureStderr();
    const Result<cv::Mat> image = decoded_image(bytes, cv::IMREAD_GRAYSCALE);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    return image ? "whole" : image.error().what;
  }

  static void expect_pixels(const std::string& bytes, const cv::Mat& pixels) {
    ::testing::internal::CaptureStderr();
    const Result<cv::Mat> image = decoded_image(bytes, cv::IMREAD_GRAYSCALE);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    ASSERT_TRUE(image.ok()) << image.error().what;
    ASSERT_EQ(image->size(), pixels.size());
    EXPECT_EQ(cv::norm(*image, pixels, cv::NORM_INF), 0);
  }
};

TEST_F(ImageBytes, AWholeImageIsGivenBackAsItIs) {
  for (const std::string& jpeg : jpegs()) EXPECT_TRUE(sound_image(jpeg).value() == jpeg);
  const std::string png = encoded(".png");
  EXPECT_TRUE(sound_image(png).value() == png);
}

TEST_F(ImageBytes, AJpegWithoutItsEndMarkerHasItsPixels) {
  for (const std::string& jpeg : jpegs()) {
    expect_pixels(jpeg.substr(0, jpeg.size() - 2), plainly_decoded(jpeg));
    expect_pixels(jpeg.substr(0, jpeg.size() - 1), plainly_decoded(jpeg));
  }
}

TEST_F(ImageBytes, AJpegThatLacksDataIsCutShortWhateverItEndsWith) {
  for (const std::string& jpeg : jpegs()) {
    // The last byte of data may hold nothing but padding.
    for (std::size_t size = 9; size + 4 < jpeg.size(); size += 1 + size / 40) {
      EXPECT_EQ(verdict(jpeg.substr(0, size)), "is truncated") << size << " of " << jpeg.size();
    }
    for (const double part : {0.5, 0.7, 0.9, 0.98}) {
      const auto size = static_cast<std::size_t>(part * static_cast<double>(jpeg.size()));
      EXPECT_NE(verdict(jpeg.substr(0, size) + std::string(kEndMarker)), "whole") << part;
    }
  }
}

TEST_F(ImageBytes, AProgressiveJpegWithoutItsLastScansIsCutShort) {
  const std::string jpeg = encoded(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  const std::size_t last_scan = jpeg.rfind("\xff\xda");
  ASSERT_NE(last_scan, std::string::npos);
  EXPECT_EQ(verdict(jpeg.substr(0, last_scan)), "is truncated");
}

TEST_F(ImageBytes, WhatFollowsAJpegsEndDoesNotMatter) {
  const std::string jpeg = encoded(".jpg");
  expect_pixels(jpeg + "a trailer", plainly_decoded(jpeg));
  expect_pixels(jpeg + encoded(".jpg", {}, picture(16, 16)), plainly_decoded(jpeg));
}

TEST_F(ImageBytes, PaddingBeforeAJpegsEndMarkerDoesNotMatter) {
  const std::string jpeg = encoded(".jpg");
  const std::string data = jpeg.substr(0, jpeg.size() - 2);
  expect_pixels(data + std::string(4, '\0') + std::string(kEndMarker), plainly_decoded(jpeg));
  EXPECT_EQ(verdict(data + std::string(40, '\x55') + std::string(kEndMarker)), "is damaged");
}

TEST_F(ImageBytes, AThumbnailsEndIsNotThatOfTheImage) {
  // An application segment that holds an end marker, as an EXIF thumbnail does.
  const std::string whole = encoded(".jpg");
  const std::string segment("\xff\xe5\x00\x06\xff\xd9\xff\xd9", 8);
  const std::string with_segment = whole.substr(0, 2) + segment + whole.substr(2);
  EXPECT_EQ(verdict(with_segment), "whole");
  EXPECT_EQ(verdict(with_segment.substr(0, with_segment.size() / 2)), "is truncated");
}

TEST_F(ImageBytes, AJpegOfBrokenCodesIsDamaged) {
  std::string jpeg = encoded(".jpg", {cv::IMWRITE_JPEG_RST_INTERVAL, 2});
  const std::size_t restart = jpeg.find("\xff\xd3");
  ASSERT_NE(restart, std::string::npos);
  jpeg.erase(restart, 2);
  EXPECT_EQ(verdict(jpeg), "is damaged");
}

TEST_F(ImageBytes, ADamagedJpegNeverSpeaks) {
  cv::RNG random(5);
  for (const std::string& jpeg : jpegs()) {
    for (int trial = 0; trial < 60; ++trial) {
      std::string damaged = jpeg;
      const auto at = static_cast<std::size_t>(random.uniform(2, static_cast<int>(jpeg.size())));
      damaged[at] = static_cast<char>(damaged[at] ^ random.uniform(1, 256));
      EXPECT_NE(verdict(damaged), "");  // verdict() expects that nothing is printed
    }
  }
}

TEST_F(ImageBytes, APngThatLacksDataIsCutShort) {
  const std::string png = encoded(".png");
  for (std::size_t size = 9; size + 16 < png.size(); size += 1 + size / 40) {
    EXPECT_EQ(verdict(png.substr(0, size)), "is truncated") << size;
  }
}

TEST_F(ImageBytes, APngWithoutItsEndChunkHasItsPixels) {
  const std::string png = encoded(".png");
  expect_pixels(png.substr(0, png.size() - 12), plainly_decoded(png));
  expect_pixels(png.substr(0, png.size() - 5), plainly_decoded(png));
}

TEST_F(ImageBytes, APngWithABrokenChecksumIsDamaged) {
  std::string png = encoded(".png");
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 1);
  EXPECT_EQ(verdict(png), "is damaged");
}

TEST_F(ImageBytes, ARemarkThatTheDecoderDislikesCostsNoPixel) {
  // A colour profile of two bytes, before the image's data.
  const std::string png = encoded(".png");
  const std::string profile("\x00\x00\x00\x02iCCPxx\x00\x00\x00\x00", 14);
  const std::string with_profile = png.substr(0, 33) + profile + png.substr(33);
  expect_pixels(with_profile, plainly_decoded(png));
}

TEST_F(ImageBytes, OtherFormatsCutShortAreNotDecodedAndSayNothing) {
  cv::Mat gray;
  cv::cvtColor(picture(64, 48), gray, cv::COLOR_BGR2GRAY);
  for (const char* extension : {".pgm", ".bmp", ".tiff", ".webp", ".jp2"}) {
    const std::string whole = encoded(extension, {}, gray);
    EXPECT_EQ(verdict(whole), "whole") << extension;
    EXPECT_EQ(verdict(whole.substr(0, whole.size() * 6 / 10)), "cannot be decoded") << extension;
    EXPECT_EQ(verdict(whole.substr(0, 10)), "cannot be decoded") << extension;
  }
  EXPECT_EQ(verdict(""), "cannot be decoded");
}

}  // namespace
}  // namespace milepost
