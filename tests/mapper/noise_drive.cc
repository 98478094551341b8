#include "tests/mapper/noise_drive.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace milepost::testing {

Drive noise_drive(const std::filesystem::path& folder, const std::string& name, int frames,
                  int seed, int brightest) {
  Drive drive;
  drive.folder = folder;
  drive.name = name;
  drive.images = name;
  drive.camera = {96, 80, 60, 60, 48, 40};
  std::filesystem::create_directories(folder / name);
  const LocalFrame local({49, 8.4, 110});
  cv::RNG random(static_cast<std::uint64_t>(seed));
  for (int i = 0; i < frames; ++i) {
    cv::Mat image(80, 96, CV_8U);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(image, image, {}, 1.5);
    cv::normalize(image, image, 0, brightest, cv::NORM_MINMAX);
    Frame frame;
    frame.filename = std::to_string(i) + ".png";
    frame.timestamp_s = 0.2 * i;
    frame.position = local.geo_from_enu({0, 2.0 * i, 0});
    EXPECT_TRUE(cv::imwrite((folder / name / frame.filename).string(), image));
    drive.frames.push_back(frame);
  }
  return drive;
}

}  // namespace milepost::testing
