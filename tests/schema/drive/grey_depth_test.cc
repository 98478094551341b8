#include "schema/drive/grey_depth.h"

#include <gtest/gtest.h>

#include <fstream>

#include <opencv2/imgcodecs.hpp>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

class GreyDepth : public ::testing::Test {
 protected:
  // An image whose greatest value is `greatest`.
  fs::path image(const std::string& name, int greatest, int type = CV_16UC1) const {
    cv::Mat values(8, 8, type, cv::Scalar::all(greatest / 3.0));
    values.row(2).setTo(cv::Scalar::all(greatest));
    EXPECT_TRUE(cv::imwrite((folder_ / name).string(), values));
    return folder_ / name;
  }

  fs::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  testing::TempFolder folder_;
};

TEST_F(GreyDepth, IsThatOfTheGreatestValue) {
  for (const auto& [greatest, bits] : {std::pair{0, 8},
                                       {255, 8},
                                       {256, 10},
                                       {1023, 10},
                                       {1024, 12},
                                       {4095, 12},
                                       {4096, 14},
                                       {16383, 14},
                                       {16384, 16},
                                       {65535, 16}}) {
    for (const char* name : {"a.png", "a.tif", "a.pgm"}) {
      // A PGM of OpenCV declares 65535, which is not significant.
      EXPECT_EQ(grey_bits_of({image(name, greatest)}), bits) << name << " of " << greatest;
    }
  }
  EXPECT_EQ(grey_bits_of({image("c.png", 4000, CV_16UC3)}), 12);
}

TEST_F(GreyDepth, IsOneForAllImagesOfARecording) {
  const fs::path dark = image("dark.png", 300);
  const fs::path bright = image("bright.png", 4000);
  EXPECT_EQ(grey_bits_of({dark, dark, bright, dark}), 12);
  EXPECT_EQ(grey_bits_of({dark, dark}), 10);
  // The first, the last and some between are sampled, however many there are.
  std::vector<fs::path> many(1000, dark);
  many.back() = bright;
  EXPECT_EQ(grey_bits_of(many), 12);
}

TEST_F(GreyDepth, OfImagesOf8BitsIs8) {
  EXPECT_EQ(grey_bits_of({image("a.png", 200, CV_8UC1), image("a.jpg", 200, CV_8UC3)}), 8);
  EXPECT_EQ(grey_bits_of({}), 8);
  EXPECT_EQ(grey_bits_of({folder_ / "none.png", file("text.png", "no image")}), 8);
}

TEST_F(GreyDepth, IsAtLeastWhatTheImagesDeclare) {
  // A dark frame of a 12-bit camera, as a PGM that declares the depth.
  std::string pgm = "P5\n# a dark tunnel\n4 4\n4095\n";
  for (int i = 0; i < 16; ++i) pgm += std::string("\x00\x1e", 2);
  EXPECT_EQ(grey_bits_of({file("dark.pgm", pgm)}), 12);

  // The same with the chunk sBIT, of which libpng does not verify the checksum.
  image("dark.png", 300);
  std::ostringstream png;
  png << std::ifstream(folder_ / "dark.png", std::ios::binary).rdbuf();
  const std::string sbit("\x00\x00\x00\x01sBIT\x0e\x00\x00\x00\x00", 13);
  const std::string with_sbit = png.str().substr(0, 33) + sbit + png.str().substr(33);
  EXPECT_EQ(grey_bits_of({file("declared.png", with_sbit)}), 14);

  // And with TIFF's MaxSampleValue, which here replaces the entry next to Photometric.
  const std::string tiff = [] {
    const auto u16 = [](int v) {
      return std::string{static_cast<char>(v & 255), static_cast<char>(v >> 8)};
    };
    const auto u32 = [&](int v) { return u16(v & 65535) + u16(v >> 16); };
    const auto entry = [&](int tag, int type, int value) {
      return u16(tag) + u16(type) + u32(1) + u32(value);
    };
    std::string text = std::string("II*\0", 4) + u32(8) + u16(9) + entry(256, 3, 2) +
                       entry(257, 3, 2) + entry(258, 3, 16) + entry(259, 3, 1) + entry(262, 3, 1) +
                       entry(273, 4, 122) + entry(278, 3, 2) + entry(279, 4, 8) +
                       entry(281, 3, 4095) + u32(0);
    return text + u16(30) + u16(31) + u16(32) + u16(33);
  }();
  EXPECT_EQ(grey_bits_of({file("dark.tif", tiff)}), 12);
}

TEST_F(GreyDepth, TheMostSignificantBitsAreKept) {
  cv::Mat values = (cv::Mat_<std::uint16_t>(1, 5) << 0, 15, 16, 4095, 5000);
  cv::Mat expected = (cv::Mat_<std::uint8_t>(1, 5) << 0, 0, 1, 255, 255);
  EXPECT_EQ(cv::norm(in_8_bits(values, 12), expected, cv::NORM_INF), 0);
  values = (cv::Mat_<std::uint16_t>(1, 3) << 7, 255, 256);
  expected = (cv::Mat_<std::uint8_t>(1, 3) << 7, 255, 255);
  EXPECT_EQ(cv::norm(in_8_bits(values, 8), expected, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace milepost
