#include "client/evaluate/baselines/vanishing_clustering.h"

#include <gtest/gtest.h>

#include "tests/client/global/edge_scene.h"

namespace milepost {
namespace {

using testing::EdgeScene;
using testing::kEdgeView;
using testing::level_direction;
using testing::turn;

TEST(ClusteredVanishingDirections, LinesAreClassedAndOutliersLeftOut) {
  const EdgeScene scene({{0, 1, 0}, level_direction(35), level_direction(-55)},
                        turn(5, Eigen::Vector3d::UnitX()), 0.3, 30, 40);
  testing::expect_lines_classed(scene, clustered_vanishing_directions(scene.segments, kEdgeView));
}

TEST(ClusteredVanishingDirections, AreFoundRoughly) {
  const EdgeScene scene({{0, 1, 0}, level_direction(35), level_direction(-55)},
                        turn(5, Eigen::Vector3d::UnitX()), 0.3, 30, 20);
  const VanishingDirections found = clustered_vanishing_directions(scene.segments, kEdgeView);
  for (std::size_t d = 0; d < 3; ++d) {
    EXPECT_LT(testing::nearest_deg(found, scene.camera_from_level * scene.directions[d],
                                   d == 0 ? Orientation::vertical : Orientation::horizontal),
              4.0)
        << d;
  }
}

}  // namespace
}  // namespace milepost
