#include "schema/tile/tracklet.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

TEST(Tracklet, TheVariableOfTheRegressionIsTheModels) {
  EXPECT_DOUBLE_EQ(scale_variable(ScaleModel::scale, 4), 4);
  EXPECT_DOUBLE_EQ(scale_variable(ScaleModel::inverse_scale, 4), -0.25);
}

// A feature at 130 m whose scale is 200 / distance: seen with 8 px from 25 m before it.
TEST(Tracklet, EstimatesArcLengthFromScale) {
  Tracklet tracklet;
  tracklet.offset_m = 130;
  tracklet.slope = 200;
  EXPECT_DOUBLE_EQ(tracklet.along_estimate_m(ScaleModel::inverse_scale, 8), 105);
  tracklet.offset_m = 90;
  tracklet.slope = 2;
  EXPECT_DOUBLE_EQ(tracklet.along_estimate_m(ScaleModel::scale, 8), 106);
}

TEST(TrackletTile, AlongHoldsEveryTracklet) {
  TrackletTile tile;
  tile.tracklets.resize(3);
  tile.tracklets[0].along = {12, 20};
  tile.tracklets[1].along = {10, 15};
  tile.tracklets[2].along = {13, 41};
  EXPECT_EQ(tile.along().from_m, 10);
  EXPECT_EQ(tile.along().to_m, 41);
}

}  // namespace
}  // namespace milepost
