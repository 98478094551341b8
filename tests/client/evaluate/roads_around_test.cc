// The roads of the map around a drive.
#include "client/evaluate/roads_around.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/client/fetch/memory_source.h"

namespace milepost {
namespace {

const MapVersion kAroundTown = {"town", "b1"};

GeoPoint around_town(double east_m, double north_m) {
  static const LocalFrame frame({49.0, 8.4, 100});
  return frame.geo_from_enu({east_m, north_m, 0});
}

// Two roads that join; the way on parts into two, and another road far away.
class JoiningAndParting : public testing::MemorySource {
 public:
  JoiningAndParting() : MemorySource(kAroundTown, "layer", nlohmann::json::object()) {
    add_road("west", {around_town(-80, 0), around_town(0, 0)}, {"on"});
    add_road("south", {around_town(0, -80), around_town(0, 0)}, {"on"});
    add_road("on", {around_town(0, 0), around_town(100, 0)}, {"left", "right"});
    add_road("left", {around_town(100, 0), around_town(150, 80)}, {});
    add_road("right", {around_town(100, 0), around_town(150, -80)}, {});
    add_road("far", {around_town(900, 0), around_town(900, 80)}, {});
  }

 private:
  void add_road(const std::string& id, const std::vector<GeoPoint>& vertices,
                const std::vector<std::string>& successors) {
    SegmentDescription road{id, RouteLine::from_vertices(vertices)->length_m(), vertices, {}};
    for (const std::string& next : successors) road.successors.push_back({next, kAroundTown.map});
    add(road, {});
  }
};

class RoadsAround : public ::testing::Test {
 protected:
  RoadsAround() {
    for (double east_m = -60; east_m < 90; east_m += 2) {
      Frame frame;
      frame.position = around_town(east_m, 1);
      drive_.frames.push_back(frame);
    }
    EvaluatedFix on;
    on.frame.fix.version = kAroundTown;
    on.frame.fix.segment = "on";
    on.frame.fix.along_m = 50;
    method_.fixes = {EvaluatedFix(), on};
  }

  const RoadAround* find(const std::string& segment) {
    roads_ = roads_around(drive_, {method_}, town_).value();
    const auto found = std::ranges::find_if(
        roads_, [&](const RoadAround& road) { return road.segment.segment == segment; });
    return found == roads_.end() ? nullptr : &*found;
  }

  Drive drive_;
  MethodEvaluation method_;
  JoiningAndParting town_;
  std::vector<RoadAround> roads_;
};

TEST_F(RoadsAround, AreThoseNearTheDriveAndThoseOfItsFixes) {
  ASSERT_NE(find("right"), nullptr);
  EXPECT_EQ(roads_.size(), 5U);
  EXPECT_EQ(find("far"), nullptr);
  method_.fixes[1].frame.fix.segment = "far";
  ASSERT_NE(find("far"), nullptr);
  EXPECT_TRUE(find("far")->is_driven);
  EXPECT_FALSE(find("on")->is_driven);
}

TEST_F(RoadsAround, KnowWhereWaysPartAndJoin) {
  EXPECT_TRUE(find("on")->begins_at_junction);
  EXPECT_TRUE(find("on")->ends_at_junction);
  EXPECT_FALSE(find("west")->begins_at_junction);
  EXPECT_FALSE(find("west")->ends_at_junction);
  EXPECT_FALSE(find("left")->begins_at_junction);
}

TEST_F(RoadsAround, WithoutASegmentOfAFixAreAnError) {
  method_.fixes[1].frame.fix.segment = "nowhere";
  const auto roads = roads_around(drive_, {method_}, town_);
  ASSERT_FALSE(roads.ok());
  EXPECT_EQ(roads.error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace milepost
