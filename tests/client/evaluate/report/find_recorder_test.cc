// What is kept of a finder's inside, of a drive whose length and fate are not known before.
#include "client/evaluate/report/find_recorder.h"

#include <gmock/gmock.h>

#include "tests/client/evaluate/found_run.h"

namespace milepost {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using testing::FoundRun;
using testing::idle_finder;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr auto kSearching = FindStatus::initializing;
constexpr auto kTracking = FindStatus::tracking;
constexpr auto kLost = FindStatus::lost;

std::vector<std::size_t> shown(const FindRecorder& recorder) {
  std::vector<std::size_t> frames;
  for (const FindSnapshot& snapshot : recorder.chosen(6)) frames.push_back(snapshot.frame);
  return frames;
}

std::vector<std::size_t> shown_of(const std::vector<FindStatus>& statuses) {
  const Finder finder = idle_finder(200);
  FindRecorder recorder;
  for (std::size_t i = 0; i < statuses.size(); ++i) recorder.observe(i, statuses[i], finder);
  return shown(recorder);
}

TEST(FindRecorder, ShowsStartSearchFindingAndEnd) {
  const auto frames = shown(FoundRun(200, 100).recorder);
  ASSERT_THAT(frames, SizeIs(6));
  EXPECT_EQ(frames[0], 0U);
  EXPECT_NEAR(static_cast<double>(frames[1]), 50, 4);
  EXPECT_EQ(frames[2], 100U);
  EXPECT_NEAR(static_cast<double>(frames[3]), 133, 4);
  EXPECT_NEAR(static_cast<double>(frames[4]), 166, 4);
  EXPECT_EQ(frames[5], 199U);
}

TEST(FindRecorder, ShowsWhereItWasFoundAndLostAtFirst) {
  std::vector<FindStatus> statuses(500, kSearching);
  const auto set = [&](std::size_t from, std::size_t to, FindStatus status) {
    for (std::size_t i = from; i < to; ++i) statuses[i] = status;
  };
  set(101, 203, kTracking);
  set(203, 301, kLost);
  set(301, 407, FindStatus::predicted);
  set(407, 500, kLost);
  const auto frames = shown_of(statuses);
  EXPECT_THAT(frames, SizeIs(6));
  EXPECT_THAT(frames, Contains(101U));
  EXPECT_THAT(frames, Contains(203U));
  EXPECT_THAT(frames, Not(Contains(301U)));
  EXPECT_THAT(frames, Not(Contains(407U)));
}

TEST(FindRecorder, ShortRunsAreShownWhole) {
  EXPECT_THAT(shown_of({kTracking}), ElementsAre(0U));
  EXPECT_THAT(shown_of({kSearching, kTracking, kLost}), ElementsAre(0U, 1U, 2U));
  EXPECT_THAT(shown(FindRecorder()), IsEmpty());
}

TEST(FindRecorder, OfAnyCloudASnapshotHasAtMost1500Particles) {
  const Finder few = idle_finder(300);
  const Finder many = idle_finder(4000);
  FindRecorder recorder;
  recorder.observe(0, kSearching, few);
  recorder.observe(1, kSearching, many);
  const std::vector<FindSnapshot> snapshots = recorder.chosen(6);
  ASSERT_THAT(snapshots, SizeIs(2));
  EXPECT_THAT(snapshots[0].particles, SizeIs(300));
  EXPECT_THAT(snapshots[1].particles, SizeIs(1500));
}

}  // namespace
}  // namespace milepost
