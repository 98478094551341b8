#include "mapper/pipeline/trained_projection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using testing::TempFolder;

// A drive of `frames` frames of blurred noise, 2 m apart.
Drive noise_drive(const std::filesystem::path& folder, const std::string& name, int frames,
                  int seed) {
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
    cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
    Frame frame;
    frame.filename = std::to_string(i) + ".png";
    frame.timestamp_s = 0.2 * i;
    frame.position = local.geo_from_enu({0, 2.0 * i, 0});
    EXPECT_TRUE(cv::imwrite((folder / name / frame.filename).string(), image));
    drive.frames.push_back(frame);
  }
  return drive;
}

std::vector<StretchPlan> plans_of(const std::vector<Drive>& drives) {
  std::vector<StretchPlan> plans;
  for (const Drive& drive : drives) plans.push_back(plan_stretch(drive, 0.3).value());
  return plans;
}

Result<PcaProjection> codebook_of(const std::vector<Drive>& drives) {
  return trained_projection(drives, plans_of(drives), {}, 2);
}

// The frames that the codebook is trained on: those that must exist.
std::vector<std::size_t> sampled_of(const std::vector<Drive>& drives, const Drive& drive) {
  std::vector<std::size_t> sampled;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const std::filesystem::path hidden = drive.folder / "hidden";
    std::filesystem::rename(drive.frame_path(drive.frames[i]), hidden);
    if (!codebook_of(drives).ok()) sampled.push_back(i);
    std::filesystem::rename(hidden, drive.frame_path(drive.frames[i]));
  }
  return sampled;
}

TEST(SampledCodebook, TakesFramesFromAllOfEachDrive) {
  const TempFolder folder;
  const std::vector<Drive> drives = {noise_drive(folder.path(), "a", 35, 1),
                                     noise_drive(folder.path(), "b", 13, 2)};
  const std::vector<std::size_t> of_a = sampled_of(drives, drives[0]);
  const std::vector<std::size_t> of_b = sampled_of(drives, drives[1]);
  EXPECT_EQ(of_a.size() + of_b.size(), 16U);
  EXPECT_NEAR(static_cast<double>(of_b.size()), 16 * 13.0 / 48, 1);
  for (const auto& [sampled, frames] : {std::pair(of_a, 35U), std::pair(of_b, 13U)}) {
    ASSERT_FALSE(sampled.empty());
    EXPECT_LT(sampled.front(), 3U);
    EXPECT_GE(sampled.back() + 3, frames);
    for (std::size_t i = 1; i < sampled.size(); ++i) EXPECT_EQ(sampled[i] - sampled[i - 1], 3U);
  }
}

TEST(SampledCodebook, TakesAllOfFewFrames) {
  const TempFolder folder;
  const std::vector<Drive> drives = {noise_drive(folder.path(), "a", 3, 1)};
  EXPECT_EQ(sampled_of(drives, drives[0]).size(), 3U);
  const Result<PcaProjection> projection = codebook_of(drives);
  ASSERT_TRUE(projection.ok());
  EXPECT_EQ(projection->quantization_step(), BuildSettings{}.quantization_step);
  EXPECT_TRUE(*projection == *codebook_of(drives));
}

TEST(SampledCodebook, DependsOnEveryDrive) {
  const TempFolder folder;
  const Drive a = noise_drive(folder.path(), "a", 4, 1);
  const Drive b = noise_drive(folder.path(), "b", 4, 2);
  const PcaProjection both = codebook_of({a, b}).value();
  EXPECT_FALSE(both == codebook_of({a}).value());
  EXPECT_FALSE(both == codebook_of({b}).value());
}

}  // namespace
}  // namespace milepost
