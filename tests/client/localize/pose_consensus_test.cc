#include "client/localize/pose_consensus.h"

#include <gtest/gtest.h>

#include "tests/client/localize/landmark_scene.h"

namespace milepost {
namespace {

using testing::angle_error_deg;
using testing::kSceneCamera;
using testing::LandmarkScene;
using testing::position_error_m;

// Fifty matches, 30 of them outliers, and a belief as uncertain as at a start.
struct MostlyWrong {
  LandmarkScene scene{50};
  PoseBelief before;
  PoseSolverSettings solver{.iterations = 1};  // so it must start near the solution

  MostlyWrong() {
    for (std::size_t i = 0; i < 30; ++i) scene.matches[i].landmark = (7 * i + 11) % 50;
    before = LandmarkScene::belief(scene.state(), 2, 1);
    before.P(kHeading, kHeading) = std::pow(10 * kRadPerDeg, 2);
    before.x.head<3>() += Eigen::Vector3d(3, -2, 0.3);
    before.x[kHeading] -= 15 * kRadPerDeg;
  }

  std::optional<PoseEstimate> estimate() const {
    const PoseSolver of_matches(kSceneCamera, scene.features, scene.landmarks, solver);
    return estimate_by_consensus(of_matches, before, scene.matches, {});
  }
};

TEST(PoseConsensus, FindsThePoseAmongWrongMatches) {
  const MostlyWrong matches;
  const LandmarkScene& scene = matches.scene;
  const PoseSolver solver(kSceneCamera, scene.features, scene.landmarks, matches.solver);
  const PoseBelief& before = matches.before;
  const PoseEstimate from_belief = solver.estimate(before, before.x, scene.matches);
  ASSERT_GT(position_error_m(from_belief.belief, scene.pose), 1);  // not found without sampling

  const auto estimate = matches.estimate();
  ASSERT_TRUE(estimate);
  EXPECT_LT(position_error_m(estimate->belief, matches.scene.pose), 0.05);
  EXPECT_LT(angle_error_deg(estimate->belief, matches.scene.pose), 0.2);
  EXPECT_GE(estimate->agreeing.size(), 20U);
  EXPECT_LE(estimate->agreeing.size(), 23U);
}

TEST(PoseConsensus, GivesTheSameTwice) {
  const MostlyWrong matches;
  const auto once = matches.estimate();
  const auto twice = matches.estimate();
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(once->belief.x, twice->belief.x);
  EXPECT_EQ(once->belief.P, twice->belief.P);
}

TEST(PoseConsensus, NeedsTwoMatches) {
  const LandmarkScene scene(2);
  const PoseSolver solver(kSceneCamera, scene.features, scene.landmarks, {});
  const PoseBelief before = LandmarkScene::belief(scene.state(), 1, 1);
  EXPECT_FALSE(estimate_by_consensus(solver, before, {}, {}));
  EXPECT_FALSE(estimate_by_consensus(solver, before, {{0, 0}}, {}));
  EXPECT_TRUE(estimate_by_consensus(solver, before, scene.matches, {}));
}

TEST(AlongByScale, IsExactOnAStraightLine) {
  const GeoPoint start = {49, 8.4, 110};
  const LocalFrame window(start);
  const GeoPoint end = window.geo_from_enu({120, 160, 0});  // 200 m, heading 36.87 degrees
  const auto line = RouteLine::from_vertices({start, end});
  ASSERT_TRUE(line.ok());
  constexpr double kAlongM = 50;
  CameraPose pose;
  const EnuPoint at = window.enu_from_geo(line->point_at(kAlongM));
  pose.enu_m = {at.east_m, at.north_m, at.up_m};
  pose.heading_rad = line->heading_deg_at(kAlongM) * kRadPerDeg;
  std::vector<LocalLandmark> landmarks;
  std::vector<Feature> features;
  std::vector<LandmarkMatch> matches;
  for (const double x_m : {-6.0, 1.0, 9.0}) {
    const Eigen::Vector3d seen(x_m, -1, 22 + x_m);
    LocalLandmark landmark =
        testing::landmark_at(pose.enu_m + camera_from_enu(pose).transpose() * seen, 0.3);
    landmark.mapped_at_m = 48;
    const EnuPoint middle = window.enu_from_geo(line->point_at(landmark.mapped_at_m));
    landmark.mapped_ahead_m = (landmark.enu_m.x() - middle.east_m) * std::sin(pose.heading_rad) +
                              (landmark.enu_m.y() - middle.north_m) * std::cos(pose.heading_rad);
    landmark.size_sigma = 0.03;
    landmark.depth_sigma_m = 0.5;
    landmarks.push_back(landmark);
    features.push_back(testing::seen_feature(landmark, pose));
    matches.push_back({matches.size(), matches.size()});
  }
  const auto estimates = along_by_scale(matches, features, landmarks, kSceneCamera, 0.04);
  ASSERT_EQ(estimates.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const double depth_m = point_in_camera(pose, landmarks[i].enu_m).z();
    EXPECT_NEAR(estimates[i].along_m, kAlongM, 2e-3);
    EXPECT_NEAR(estimates[i].sigma_m, std::hypot(0.05 * depth_m, 0.5), 1e-4);
  }
}

}  // namespace
}  // namespace milepost
