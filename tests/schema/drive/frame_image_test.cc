#include "schema/drive/frame_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/schema/drive/drive_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

cv::Mat smooth_image(int width_px, int height_px) {
  cv::Mat image(height_px, width_px, CV_8UC3);
  cv::randu(image, 0, 255);
  cv::GaussianBlur(image, image, {}, 2);
  return image;
}

std::string encoded(const std::string& extension, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes);
  return {bytes.begin(), bytes.end()};
}

// A drive whose second frame (line 3) has these bytes for its image.
class FrameImage : public ::testing::Test {
 protected:
  Result<cv::Mat> read_second_frame(const std::string& bytes) {
    folder_.write("frames/b.png", bytes);
    const Result<Drive> drive = read_drive(folder_.path());
    if (!drive) return drive.error();
    return FrameReader(*drive).gray(1);
  }

  std::string refusal(const std::string& bytes) {
    const Result<cv::Mat> image = read_second_frame(bytes);
    return image ? "accepted" : image.error().line();
  }

  std::string start_of_line() const {
    return folder_.file("trajectory.csv") + ", line 3: image " + folder_.file("frames/b.png");
  }

  DriveFolder folder_;
};

TEST_F(FrameImage, GivesGrey) {
  const cv::Mat image = smooth_image(16, 12);
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  const Result<cv::Mat> read = read_second_frame(encoded(".png", image));
  ASSERT_TRUE(read.ok()) << read.error().line();
  ASSERT_EQ(read->type(), CV_8UC1);
  EXPECT_LE(cv::norm(*read, gray, cv::NORM_INF), 1);
}

TEST_F(FrameImage, ReadsOtherFormatsToo) {
  for (const char* extension : {".jpg", ".bmp", ".tiff"}) {
    const Result<cv::Mat> read = read_second_frame(encoded(extension, smooth_image(16, 12)));
    EXPECT_TRUE(read.ok()) << extension << ": " << read.error().line();
  }
}

TEST_F(FrameImage, RefusesAnImageThatIsGone) {
  const Result<Drive> drive = read_drive(folder_.path());
  ASSERT_TRUE(drive.ok());
  std::filesystem::remove(folder_.path() / "frames" / "b.png");
  const Result<cv::Mat> image = FrameReader(*drive).gray(1);
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().code, ErrorCode::not_found);
  EXPECT_EQ(image.error().line(),
            start_of_line() + ": there is no such file; restore the image or remove the row");
}

TEST_F(FrameImage, RefusesWhatIsNoImage) {
  EXPECT_EQ(refusal("no image at all"),
            start_of_line() + " cannot be decoded; replace the image or remove the row");
  EXPECT_THAT(refusal(""), HasSubstr("cannot be decoded"));
}

TEST_F(FrameImage, RefusesAnotherSizeThanTheCameras) {
  EXPECT_EQ(refusal(encoded(".png", smooth_image(12, 16))),
            start_of_line() +
                " is 12x16 pixels, the camera's images 16x12; correct the camera's "
                "size in drive.json or the image");
  EXPECT_THAT(refusal(encoded(".png", smooth_image(15, 12))), HasSubstr(" is 15x12 pixels"));
  EXPECT_THAT(refusal(encoded(".png", smooth_image(16, 11))), HasSubstr(" is 16x11 pixels"));
}

// A JPEG with an EXIF orientation of 6: shown turned by a right angle.
std::string turned_by_exif(const std::string& jpeg) {
  const std::string tiff("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0", 26);
  const std::string exif = std::string("Exif\0\0", 6) + tiff;
  const auto length = static_cast<char>(exif.size() + 2);
  return jpeg.substr(0, 2) + "\xff\xe1" + std::string(1, '\0') + length + exif + jpeg.substr(2);
}

TEST_F(FrameImage, NamesAnOrientationThatTurnsIt) {
  const std::string jpeg = encoded(".jpg", smooth_image(16, 12));
  ASSERT_EQ(refusal(jpeg), "accepted");
  EXPECT_EQ(refusal(turned_by_exif(jpeg)),
            start_of_line() +
                " is 12x16 pixels once its EXIF orientation is applied, the camera's images 16x12; "
                "describe the camera of the images as they are shown, or remove the orientation "
                "from the images");
}

TEST_F(FrameImage, NamesTheFrameOfADriveThatWasNotRead) {
  Drive drive;
  drive.folder = "made";
  drive.images = "frames";
  drive.frames = {{"a.png", 1, {49, 8, 0}, 0}};
  const Result<cv::Mat> image = FrameReader(drive).gray(0);
  ASSERT_FALSE(image.ok());
  EXPECT_THAT(image.error().line(),
              StartsWith("made/trajectory.csv, frame 0: image made/frames/a.png: "));
}

}  // namespace
}  // namespace milepost
