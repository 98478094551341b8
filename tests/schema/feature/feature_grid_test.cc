#include "schema/feature/feature_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace milepost {
namespace {

TEST(FeatureGrid, VisitsEveryFeatureInTheCircle) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> pixel(0, 600);
  std::vector<Feature> features(500);
  for (Feature& feature : features) feature = {pixel(random), pixel(random), 2};
  const FeatureGrid grid(features);
  for (const auto& [x, y] :
       {std::pair(0.0F, 0.0F), std::pair(300.0F, 250.0F), std::pair(700.0F, -50.0F)}) {
    std::vector<std::size_t> visited;
    grid.visit_near(x, y, 60, [&](std::size_t i) { visited.push_back(i); });
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (std::hypot(features[i].x_px - x, features[i].y_px - y) > 60) continue;
      EXPECT_THAT(visited, ::testing::Contains(i));
    }
  }
}

}  // namespace
}  // namespace milepost
