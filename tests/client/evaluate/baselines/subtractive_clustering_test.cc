#include "client/evaluate/baselines/subtractive_clustering.h"

#include <gmock/gmock.h>

#include <random>

namespace milepost {
namespace {

// `count` points about `centre`, every other one as its opposite.
void scatter(std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& centre, int count,
             std::mt19937& random) {
  std::normal_distribution<double> off(0, 0.01);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d point =
        (centre + Eigen::Vector3d(off(random), off(random), off(random))).normalized();
    points.push_back(i % 2 == 0 ? point : Eigen::Vector3d(-point));
  }
}

TEST(SubtractiveClustering, CentresAreTheDensePlacesTheDensestFirst) {
  const Eigen::Vector3d big = Eigen::Vector3d(1, 0, 0.2).normalized();
  const Eigen::Vector3d small = Eigen::Vector3d(-0.4, 0, 1).normalized();
  std::vector<Eigen::Vector3d> points;
  std::mt19937 random(3);
  scatter(points, small, 30, random);
  scatter(points, big, 60, random);
  scatter(points, {0, 1, 0}, 3, random);  // too few to be a cluster
  const auto centres = cluster_centres(points, {});
  ASSERT_EQ(centres.size(), 2u);
  EXPECT_GT(std::abs(centres[0].dot(big)), 0.9995);
  EXPECT_GT(std::abs(centres[1].dot(small)), 0.9995);
}

TEST(SubtractiveClustering, NoMoreCentresThanAskedForAndNoneWithoutPoints) {
  std::vector<Eigen::Vector3d> points;
  std::mt19937 random(4);
  scatter(points, {1, 0, 0}, 20, random);
  scatter(points, {0, 0, 1}, 20, random);
  ClusteringSettings settings;
  EXPECT_EQ(cluster_centres(points, settings).size(), 2u);
  settings.max_centres = 1;
  EXPECT_EQ(cluster_centres(points, settings).size(), 1u);
  EXPECT_TRUE(cluster_centres({}, settings).empty());
}

}  // namespace
}  // namespace milepost
