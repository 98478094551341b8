// The network and the stretches of several drives, and the passes that segments take.
#include "mapper/pipeline/build_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/mapper/noise_drive.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::noise_drive;
using testing::TempFolder;

constexpr int kRoadFrames = 60;

class PlannedBuild : public ::testing::Test {
 protected:
  // Two drives of one road, of 118 m.
  std::vector<Drive> drives(int brightest_a, int brightest_b) const {
    return {noise_drive(folder_.path(), "a", kRoadFrames, 1, brightest_a),
            noise_drive(folder_.path(), "b", kRoadFrames, 2, brightest_b)};
  }

  static std::vector<std::string> ids(const BuildPlan& plan) {
    std::vector<std::string> found;
    for (const StoredSegment& segment : plan.segments) found.push_back(segment.id);
    return found;
  }

  TempFolder folder_;
};

TEST_F(PlannedBuild, ARoadDrivenTwiceIsOneSegmentWithBothPasses) {
  const BuildPlan plan = plan_build(drives(255, 255), {}, 2).value();
  ASSERT_EQ(plan.segments.size(), 1U);
  const StoredSegment& segment = plan.segments.front();
  EXPECT_NEAR(segment.length_m, 118, 0.2);
  ASSERT_EQ(segment.passes.size(), 2U);
  EXPECT_EQ(segment.passes[0].drive, "a");
  EXPECT_EQ(segment.passes[1].drive, "b");
  EXPECT_NEAR(segment.passes[1].to_m, 118, 0.2);
  EXPECT_NEAR(segment.vertices.back().along_m, segment.length_m, 1e-9);
}

TEST_F(PlannedBuild, TheBestPassIsThatInWhichMostIsSeen) {
  BuildSettings settings;
  settings.passes = PassPolicy::keep_best;
  EXPECT_THAT(ids(plan_build(drives(255, 12), settings, 2).value()), ElementsAre("a-0"));
  EXPECT_THAT(ids(plan_build(drives(12, 255), settings, 2).value()), ElementsAre("b-0"));
  const BuildPlan equal = plan_build(drives(255, 255), settings, 2).value();
  EXPECT_THAT(ids(equal), ElementsAre("a-0"));
  ASSERT_EQ(equal.drives.size(), 2U);
  EXPECT_EQ(equal.drives[0].frames(), static_cast<std::size_t>(kRoadFrames));
  EXPECT_EQ(equal.drives[1].frames(), 0U);  // it carries no segment
}

TEST_F(PlannedBuild, FusedAllPassesAreMappedAndTheLineIsOfTheBest) {
  BuildSettings settings;
  EXPECT_EQ(settings.passes, PassPolicy::fuse);  // the default
  const BuildPlan plan = plan_build(drives(12, 255), settings, 2).value();
  EXPECT_THAT(ids(plan), ElementsAre("b-0"));
  ASSERT_EQ(plan.fused.size(), 1U);
  ASSERT_EQ(plan.fused.front().passes.size(), 2U);
  EXPECT_EQ(plan.fused.front().passes[0].stretch, 0U);
  EXPECT_EQ(plan.fused.front().passes[1].stretch, 1U);
  for (const DrivePlan& drive : plan.drives)
    EXPECT_EQ(drive.frames(), static_cast<std::size_t>(kRoadFrames));
  EXPECT_TRUE(plan.drives[0].stretches.front().segments.empty());
  EXPECT_EQ(plan.drives[1].stretches.front().segments.size(), 1U);
  settings.passes = PassPolicy::keep_best;
  EXPECT_EQ(plan_build(drives(12, 255), settings, 2)->fused.front().passes.size(), 1U);
}

TEST_F(PlannedBuild, OfAboutEqualPassesThatWithTheClosestFramesIsTaken) {
  std::vector<Drive> both = drives(255, 255);
  for (std::size_t i = 0; i < both[0].frames.size(); ++i)
    both[0].frames.erase(both[0].frames.begin() + static_cast<std::ptrdiff_t>(i));
  EXPECT_THAT(ids(plan_build(both, {}, 2).value()), ElementsAre("b-0"));
}

TEST_F(PlannedBuild, TheLatestPassReplacesOthers) {
  BuildSettings settings;
  settings.passes = PassPolicy::replace;
  std::vector<Drive> both = drives(255, 12);
  both[0].captured = "2024-05-01";
  both[1].captured = "2024-06-01";
  EXPECT_THAT(ids(plan_build(both, settings, 2).value()), ElementsAre("b-0"));
  both[0].captured = "2024-07-01";
  EXPECT_THAT(ids(plan_build(both, settings, 2).value()), ElementsAre("a-0"));
}

TEST_F(PlannedBuild, TheOrderOfTheDrivesPlaysNoPart) {
  std::vector<Drive> both = drives(255, 12);
  const BuildPlan plan = plan_build(both, {}, 2).value();
  std::ranges::reverse(both);
  const BuildPlan turned = plan_build(both, {}, 2).value();
  EXPECT_EQ(ids(turned), ids(plan));
  EXPECT_EQ(turned.segments.front().passes, plan.segments.front().passes);
  EXPECT_EQ(turned.drives.front().drive->name, "a");
}

TEST_F(PlannedBuild, TwoDrivesOfOneNameAreRefused) {
  std::vector<Drive> both = drives(255, 255);
  both[1].name = "a";
  const auto refused = plan_build(both, {}, 2);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().line(), HasSubstr("two drives have this name"));
}

TEST_F(PlannedBuild, AFrameThatCannotBeComparedIsAnError) {
  const std::vector<Drive> both = drives(255, 255);
  for (const Frame& frame : both[1].frames) std::filesystem::remove(both[1].frame_path(frame));
  EXPECT_FALSE(plan_build(both, {}, 2).ok());
}

}  // namespace
}  // namespace milepost
