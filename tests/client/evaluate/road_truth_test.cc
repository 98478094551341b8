// Recorded positions on the roads of a network, and the errors of fixes there.
#include "client/evaluate/road_truth.h"

#include <gtest/gtest.h>

#include "client/evaluate/evaluation.h"
#include "tests/client/fetch/memory_source.h"

namespace milepost {
namespace {

constexpr double kTruthMm = 0.002;
const MapVersion kTown = {"town", "b1"};

GeoPoint in_town(double east_m, double north_m, double up_m = 0) {
  static const LocalFrame frame({49.0, 8.4, 100});
  return frame.geo_from_enu({east_m, north_m, up_m});
}

// A road to the north that goes on as `next`, or as `exit` to the right; a carriageway in the
// opposite direction; a bridge over them; and a loop that comes back beside its begin.
class TownOfRoads : public testing::MemorySource {
 public:
  TownOfRoads() : MemorySource(kTown, "layer", nlohmann::json::object()) {
    add_road("road", {in_town(0, 0), in_town(0, 100)});
    add_road("next", {in_town(0, 100), in_town(0, 200)});
    add_road("exit", {in_town(0, 100), in_town(10, 130), in_town(60, 180)});
    add_road("back", {in_town(-8, 200), in_town(-8, 0)});
    add_road("bridge", {in_town(0.5, 0, 6), in_town(0.5, 100, 6)});
    add_road("loop", {in_town(300, 0), in_town(300, 80), in_town(380, 80), in_town(380, 0),
                      in_town(300.2, 0), in_town(300.2, 70)});
  }

 private:
  void add_road(const std::string& id, const std::vector<GeoPoint>& vertices) {
    add({id, RouteLine::from_vertices(vertices)->length_m(), vertices, {}}, {});
  }
};

Frame frame_at(const GeoPoint& position, double heading_deg) {
  Frame frame;
  frame.position = position;
  frame.heading_deg = heading_deg;
  return frame;
}

Fix fix_on(const std::string& segment, double along_m, const GeoPoint& position) {
  Fix fix;
  fix.status = FixStatus::tracking;
  fix.version = kTown;
  fix.segment = segment;
  fix.along_m = along_m;
  fix.sigma_m = 0.1;
  fix.position = position;
  return fix;
}

std::optional<PlaceOnRoad> place_of(const Frame& frame, const Fix& fix = {}) {
  TownOfRoads town;
  RoadTruth truth(town);
  return truth.place_of(frame, fix).value();
}

EvaluatedFix evaluated(const Frame& frame, const Fix& fix) {
  TownOfRoads town;
  Drive drive;
  drive.frames = {frame};
  return evaluate_fixes("m", "layer", drive, {{"a.jpg", fix}}, town)->fixes.front();
}

TEST(RoadTruth, HeadingTellsCarriagewaysApart) {
  EXPECT_EQ(place_of(frame_at(in_town(-3, 50), 2))->segment.segment, "road");
  const auto back = place_of(frame_at(in_town(-3, 50), 178));
  EXPECT_EQ(back->segment.segment, "back");
  EXPECT_NEAR(back->along_m, 150, 2 * kTruthMm);
  EXPECT_NEAR(back->lateral_m, -5, kTruthMm);
  EXPECT_FALSE(place_of(frame_at(in_town(-3, 50), 90)).has_value());
}

TEST(RoadTruth, AltitudeTellsTheBridgeFromTheRoadUnderIt) {
  EXPECT_EQ(place_of(frame_at(in_town(0.3, 50, 1), 0))->segment.segment, "road");
  EXPECT_EQ(place_of(frame_at(in_town(0.3, 50, 5.5), 0))->segment.segment, "bridge");
}

TEST(RoadTruth, AltitudesOfAnotherOriginDoNotCount) {
  EXPECT_EQ(place_of(frame_at(in_town(0.1, 50, 80), 0))->segment.segment, "road");
}

TEST(RoadTruth, FarFromEveryRoadThereIsNone) {
  EXPECT_FALSE(place_of(frame_at(in_town(120, 50), 0)).has_value());
}

TEST(RoadTruth, OfSegmentsAboutAsNearTheOneOfTheFixCounts) {
  const Frame frame = frame_at(in_town(0.3, 103), 5);
  EXPECT_EQ(place_of(frame, fix_on("next", 3, in_town(0, 103)))->segment.segment, "next");
  EXPECT_EQ(place_of(frame, fix_on("exit", 3, in_town(1, 103)))->segment.segment, "exit");
}

// The loop passes twice, 0.2 m apart.
TEST(RoadTruth, WhereALineOverlapsItselfThePassOfTheFixCounts) {
  const Frame frame = frame_at(in_town(300.05, 40), 0);
  EXPECT_NEAR(place_of(frame, fix_on("loop", 40.1, in_town(300, 40.1)))->along_m, 40, kTruthMm);
  const double second_m = 80 + 80 + 80 + 79.8 + 40;
  const auto again = place_of(frame, fix_on("loop", second_m, in_town(300.2, 40)));
  EXPECT_NEAR(again->along_m, second_m, 0.01);
  EXPECT_NEAR(*evaluated(frame, fix_on("loop", second_m + 0.05, in_town(300.2, 40.05))).error_m,
              0.05, 0.01);
}

TEST(RoadTruth, AFixOnAWrongRoadIsWrongByItsDistance) {
  const Frame frame = frame_at(in_town(0, 150), 0);
  const EvaluatedFix wrong = evaluated(frame, fix_on("exit", 60, in_town(30, 150)));
  EXPECT_EQ(wrong.truth_segment, "next");
  EXPECT_TRUE(wrong.is_on_wrong_segment);
  EXPECT_NEAR(*wrong.error_m, 30, kTruthMm);
  EXPECT_NEAR(*wrong.distance_m, 30, kTruthMm);
  EXPECT_FALSE(wrong.lateral_error_m.has_value());
}

TEST(RoadTruth, AcrossAJunctionAnErrorIsWhatTheFixIsAhead) {
  const Frame frame = frame_at(in_town(0, 101.5), 0);
  const EvaluatedFix before = evaluated(frame, fix_on("road", 100, in_town(0, 99.9)));
  EXPECT_TRUE(before.is_on_wrong_segment);
  EXPECT_NEAR(*before.error_m, -1.6, kTruthMm);
  const EvaluatedFix right = evaluated(frame, fix_on("next", 1.25, in_town(0.1, 101.25)));
  EXPECT_FALSE(right.is_on_wrong_segment);
  EXPECT_NEAR(*right.error_m, -0.25, kTruthMm);
  EXPECT_NEAR(*right.distance_m, std::hypot(0.25, 0.1), kTruthMm);
}

}  // namespace
}  // namespace milepost
