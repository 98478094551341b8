#include "tests/simulator/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulator/network.h"
#include "tests/simulator/runs.h"

namespace milepost::simulator {
namespace {

Motion motion_of(const Network& network, const RunPlan& run) {
  return {path_of(network, run), kLaneM, run.motion};
}

TEST(Motion, SpeedsUpAndBrakesAsAVehicleDoes) {
  const Network network = make_network(1);
  for (const RunPlan& run : make_runs(network, 1, 10000)) {
    const Motion motion = motion_of(network, run);
    for (double time_s = motion.start_s() + 0.5; time_s < motion.end_s() - 0.5; time_s += 0.2) {
      const double change = motion.speed_mps_at(time_s + 0.2) - motion.speed_mps_at(time_s - 0.2);
      EXPECT_LT(change / 0.4, 2.6) << run.name << " at " << time_s;
      EXPECT_GT(change / 0.4, -3.0) << run.name << " at " << time_s;
    }
  }
}

TEST(Motion, SlowsDownWhereItIsToldToAndInCurves) {
  const Path path = Path::through({{{0, 0}}, {{0, 200}, 12}, {{200, 200}}});
  MotionPlan plan;
  plan.to_m = 350;
  plan.slow_downs_m = {80};
  const Motion motion(path, kLaneM, plan);
  EXPECT_LT(motion.speed_mps_at(motion.time_s_at(80)), 2);
  EXPECT_GT(motion.speed_mps_at(motion.time_s_at(40)), 8);
  EXPECT_LT(motion.speed_mps_at(motion.time_s_at(path.place_of({0, 200}).along_m)), 5.2);
}

TEST(Motion, TimesAndArcLengthsAgree) {
  const Network network = make_network(1);
  const RunPlan run = make_runs(network, 1, 10000).front();
  const Motion motion = motion_of(network, run);
  for (double along = run.motion.from_m + 1; along < run.motion.to_m; along += 7.3) {
    EXPECT_NEAR(motion.along_m_at(motion.time_s_at(along)), along, 1e-6);
  }
}

TEST(Motion, ChangesLanesAsPlanned) {
  const Network network = make_network(1);
  const auto runs = make_runs(network, 1, 10000);
  const auto lane = std::find_if(runs.begin(), runs.end(), [](const RunPlan& run) {
    return run.name == "town-main-query-lane";
  });
  ASSERT_NE(lane, runs.end());
  const Motion motion = motion_of(network, *lane);
  const Path& path = network.route("town-main")->path;
  const LaneChange& out = lane->motion.lane_changes[0];
  const LaneChange& back = lane->motion.lane_changes[1];
  const auto lateral = [&](double along) {
    return path.place_of(motion.position_at(along)).lateral_m - kLaneM;
  };
  const double slack_m = 0.16;  // the vehicle sways in its lane
  EXPECT_NEAR(lateral(out.from_m), -0.3, slack_m);
  EXPECT_NEAR(lateral(out.from_m + out.over_m), -0.3 - 2 * kLaneM, slack_m);
  EXPECT_NEAR(lateral(back.from_m), -0.3 - 2 * kLaneM, slack_m);
  EXPECT_NEAR(lateral(back.from_m + back.over_m), -0.3, slack_m);
}

}  // namespace
}  // namespace milepost::simulator
