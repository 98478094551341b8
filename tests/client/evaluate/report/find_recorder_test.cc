// The recorded internal state of a global localizer, for a drive of unknown length and outcome.
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

constexpr auto kSearching = GlobalStatus::initializing;
constexpr auto kTracking = GlobalStatus::tracking;
constexpr auto kLost = GlobalStatus::lost;

std::vector<std::size_t> shown(const FindRecorder& recorder) {
  std::vector<std::size_t> frames;
  for (const FindSnapshot& snapshot : recorder.chosen(6)) frames.push_back(snapshot.frame);
  return frames;
}

std::vector<std::size_t> shown_of(const std::vector<GlobalStatus>& statuses) {
  const GlobalLocalizer localizer = idle_finder(200);
  FindRecorder recorder;
  for (std::size_t i = 0; i < statuses.size(); ++i) recorder.observe(i, statuses[i], localizer);
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
  std::vector<GlobalStatus> statuses(500, kSearching);
  const auto set = [&](std::size_t from, std::size_t to, GlobalStatus status) {
    for (std::size_t i = from; i < to; ++i) statuses[i] = status;
  };
  set(101, 203, kTracking);
  set(203, 301, kLost);
  set(301, 407, GlobalStatus::predicted);
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

TEST(FindRecorder, ASnapshotHasAtMost1500Particles) {
  const GlobalLocalizer few = idle_finder(300);
  const GlobalLocalizer many = idle_finder(4000);
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
