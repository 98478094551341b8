#include "mapper/codebook/codebook.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/pipeline/codebook_training.h"
#include "schema/base/file.h"
#include "tests/mapper/noise_drive.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using testing::noise_drive;
using testing::TempFolder;

// The drive on another road.
Drive elsewhere(Drive drive) {
  for (Frame& frame : drive.frames) frame.position.longitude_deg += 0.01;
  return drive;
}

Result<PcaProjection> codebook_of(const std::vector<Drive>& drives) {
  return trained_codebook(plan_build(drives, {}, 2)->drives, {}, 16, "trained", 2);
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
                                     elsewhere(noise_drive(folder.path(), "b", 13, 2))};
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
  const std::vector<Drive> drives = {noise_drive(folder.path(), "a", 7, 1)};
  EXPECT_EQ(sampled_of(drives, drives[0]).size(), 7U);
  const Result<PcaProjection> projection = codebook_of(drives);
  ASSERT_TRUE(projection.ok());
  EXPECT_EQ(projection->quantization_step(), BuildSettings{}.quantization_step);
  EXPECT_TRUE(*projection == *codebook_of(drives));
}

TEST(SampledCodebook, DependsOnEveryDrive) {
  const TempFolder folder;
  const Drive a = noise_drive(folder.path(), "a", 8, 1);
  const Drive b = elsewhere(noise_drive(folder.path(), "b", 8, 2));
  const PcaProjection both = codebook_of({a, b}).value();
  EXPECT_FALSE(both == codebook_of({a}).value());
  EXPECT_FALSE(both == codebook_of({b}).value());
}

TEST(ShippedCodebook, HasAVersionAndAxes) {
  EXPECT_EQ(shipped_codebook().version(), "milepost-1");
  Descriptor one{};    // a lot of one direction in the middle
  Descriptor other{};  // and of the opposite one
  for (const std::size_t cell : {5U, 6U, 9U, 10U}) {
    one[8 * cell] = 120;
    other[8 * cell + 4] = 120;
  }
  EXPECT_GT(distance_squared(shipped_codebook().compact(one), shipped_codebook().compact(other)),
            1000);
}

TEST(CodebookFile, IsReadAsItWasWritten) {
  const TempFolder folder;
  const auto file = folder.path() / "codebook.json";
  ASSERT_TRUE(write_text_file(file, codebook_text(shipped_codebook())).ok());
  EXPECT_TRUE(read_codebook(file).value() == shipped_codebook());
  ASSERT_TRUE(write_text_file(file, R"({"version": "x", "step": -1})").ok());
  const auto damaged = read_codebook(file);
  ASSERT_FALSE(damaged.ok());
  EXPECT_THAT(damaged.error().line(), ::testing::HasSubstr("codebook.json"));
  EXPECT_THAT(damaged.error().line(), ::testing::HasSubstr("milepost-mapper codebook"));
  EXPECT_EQ(read_codebook(folder.path() / "none").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace milepost
