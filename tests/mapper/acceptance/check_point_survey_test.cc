#include "mapper/acceptance/check_point_survey.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

constexpr GeoPoint kMark{49, 8.4, 120};
constexpr double kNorthM = -20;  // of the first of the frames, which drive towards the mark

// A drive of four frames that looks north and sees the mark, 3 m to the right and 1 m up.
class CheckPointSurveyTest : public ::testing::Test {
 protected:
  CheckPointSurveyTest() {
    drive_.name = "monday";
    drive_.camera = {640, 480, {500, 500, 320, 240}};
    CheckPoint point{"A", kMark, {}};
    const LocalFrame local(kMark);
    for (int i = 0; i < 4; ++i) {
      const double ahead_m = -kNorthM - 3.0 * i;
      const std::string filename = std::to_string(i) + ".png";
      point.sights.push_back(
          {"monday", filename, {320 + 500 * 3 / ahead_m, 240 - 500 * 1 / ahead_m}});
      AdjustedFrame frame;
      frame.along_m = 3.0 * i;
      frame.position = local.geo_from_enu({-3, -ahead_m, -1});
      frames_.push_back({frame, filename});
    }
    points_.push_back(point);
    line_ = *RouteLine::from_vertices(
        {local.geo_from_enu({-3, kNorthM, -1}), local.geo_from_enu({-3, 20, -1})});
  }

  CheckPointResidual residual(std::size_t frames, const PoseError& error) const {
    CheckPointSurvey survey(points_);
    for (std::size_t i = 0; i < frames; ++i)
      survey.add(drive_, frames_[i].filename, 2, frames_[i].frame);
    const auto all = survey.residuals(
        {&drive_},
        [&](std::size_t stretch, double along_m) {
          EXPECT_EQ(stretch, 2U);
          EXPECT_GT(along_m, 0);
          return error;
        },
        [&](std::size_t) -> const RouteLine& { return line_; });
    EXPECT_EQ(all.size(), 1U);
    return all.front();
  }

  struct NamedFrame {
    AdjustedFrame frame;
    std::string filename;
  };
  Drive drive_;
  std::vector<CheckPoint> points_;
  std::vector<NamedFrame> frames_;
  RouteLine line_ = *RouteLine::from_vertices({{49, 8, 0}, {49.1, 8, 0}});
};

TEST_F(CheckPointSurveyTest, AMapWithoutErrorsHasTheMarkWhereItIs) {
  const CheckPointResidual found = residual(4, {});
  EXPECT_EQ(found.mark, "A");
  EXPECT_EQ(found.drive, "monday");
  EXPECT_EQ(found.sights, 4U);
  EXPECT_TRUE(found.is_placed);
  EXPECT_NEAR(found.east_m, 0, 1e-4);
  EXPECT_NEAR(found.north_m, 0, 1e-3);
  EXPECT_NEAR(found.up_m, 0, 1e-4);
  EXPECT_LT(found.reprojection_px, 0.01);
}

TEST_F(CheckPointSurveyTest, ItIsMovedAsTheDrivesLandmarksAre) {
  const CheckPointResidual found = residual(4, {{0.2, 0.1, -0.3}, 0});
  EXPECT_NEAR(found.east_m, -0.2, 1e-3);
  EXPECT_NEAR(found.north_m, -0.1, 1e-3);
  EXPECT_NEAR(found.up_m, 0.3, 1e-3);
}

TEST_F(CheckPointSurveyTest, OneFrameDoesNotPlaceIt) {
  EXPECT_EQ(residual(1, {}).sights, 1U);
  EXPECT_FALSE(residual(1, {}).is_placed);
  EXPECT_FALSE(residual(0, {}).is_placed);
  EXPECT_TRUE(residual(2, {}).is_placed);
}

TEST(CheckPointSummary, CountsWhatIsPlaced) {
  const auto residual = [](const std::string& mark, bool is_placed) {
    CheckPointResidual made;
    made.mark = mark;
    made.drive = "monday";
    made.is_placed = is_placed;
    return made;
  };
  CheckPointResidual a = residual("A", true);
  a.east_m = 0.3;
  a.north_m = 0.4;
  a.up_m = 0.1;
  CheckPointResidual b = residual("B", true);
  b.up_m = -0.1;
  const CheckPointResidual c = residual("C", false);
  const CheckPointSummary summary = summary_of({b, a, c});
  EXPECT_EQ(summary.marks, 3U);
  EXPECT_EQ(summary.placed, 2U);
  EXPECT_NEAR(summary.plan_rms_m, 0.3536, 1e-4);
  EXPECT_NEAR(summary.up_rms_m, 0.1, 1e-9);
  EXPECT_EQ(summary.worst, "A by monday");
  EXPECT_NEAR(summary.worst_plan_m, 0.5, 1e-9);
  EXPECT_EQ(summary_of({c}).placed, 0U);
}

}  // namespace
}  // namespace milepost
