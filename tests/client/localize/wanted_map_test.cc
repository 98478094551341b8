// Which map data is wanted first.
#include "client/localize/wanted_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

const MapVersion kWantedTown = {"town", "1"};

GeoPoint in_wanted_town(double east_m, double north_m) {
  static const LocalFrame frame({49, 8.4, 110});
  return frame.geo_from_enu({east_m, north_m, 0});
}

// A road to the north that goes straight on, or to the right; and the way back beside it.
class WantedRoads : public ::testing::Test {
 protected:
  WantedRoads() {
    add("road", {in_wanted_town(0, 0), in_wanted_town(0, 100)}, {"straight", "right"});
    add("straight", {in_wanted_town(0, 100), in_wanted_town(0, 200)}, {"unknown"});
    add("right", {in_wanted_town(0, 100), in_wanted_town(20, 120), in_wanted_town(100, 120)}, {});
  }

  void add(const std::string& id, const std::vector<GeoPoint>& vertices,
           const std::vector<std::string>& successors) {
    SegmentLayer layer =
        *testing::layer_of({kWantedTown, id}, *RouteLine::from_vertices(vertices), {}, {});
    for (const std::string& next : successors) layer.successors.push_back({next, "town"});
    HeldSegment segment;
    segment.layer = std::make_shared<const SegmentLayer>(std::move(layer));
    held_.segments[{kWantedTown, id}] = std::make_shared<const HeldSegment>(std::move(segment));
  }

  // Segments with their priority, the first first.
  std::vector<std::pair<std::string, int>> wanted(const AlongRange& range,
                                                  const ExpectedRoute& route = {}) const {
    WantedMap map(held_, route);
    map.add_way(held_.find({kWantedTown, "road"})->layer, range, WantedFor::this_frame);
    std::vector<std::pair<std::string, int>> found;
    for (const Want& want : map.wants().tiles)
      found.emplace_back(want.segment.segment, want.priority);
    std::ranges::stable_sort(found, {}, &std::pair<std::string, int>::second);
    return found;
  }

  HeldMap held_;
};

TEST_F(WantedRoads, WithoutARouteTheWayOfTheMappingDriveComesFirst) {
  EXPECT_THAT(wanted({50, 150}),
              ElementsAre(Pair("road", 0), Pair("straight", 0), Pair("right", 1)));
  EXPECT_THAT(wanted({50, 250}), ElementsAre(Pair("road", 0), Pair("straight", 0),
                                             Pair("unknown", 1), Pair("right", 1)));
}

TEST_F(WantedRoads, TheRouteDecidesWhichBranchComesFirst) {
  const auto route = ExpectedRoute::through({in_wanted_town(3, -500), in_wanted_town(3, 98),
                                             in_wanted_town(18, 116), in_wanted_town(900, 116)});
  EXPECT_THAT(wanted({50, 150}, *route),
              ElementsAre(Pair("road", 0), Pair("right", 0), Pair("straight", 1)));
}

TEST_F(WantedRoads, ARouteElsewhereOrTheOtherWayDecidesNothing) {
  const std::vector<std::vector<GeoPoint>> routes = {
      {in_wanted_town(500, 0), in_wanted_town(500, 900)},
      {in_wanted_town(90, 120), in_wanted_town(18, 118), in_wanted_town(0, 0)}};
  for (const std::vector<GeoPoint>& route : routes) {
    EXPECT_THAT(wanted({50, 150}, *ExpectedRoute::through(route)),
                ElementsAre(Pair("road", 0), Pair("straight", 0), Pair("right", 1)));
  }
}

TEST_F(WantedRoads, TheBuildOfAnUnknownNeighbourIsAskedFor) {
  SegmentLayer layer = *held_.find({kWantedTown, "right"})->layer;
  layer.successors = {{"far", "east"}};
  HeldSegment segment;
  segment.layer = std::make_shared<const SegmentLayer>(std::move(layer));
  held_.segments[{kWantedTown, "right"}] = std::make_shared<const HeldSegment>(std::move(segment));
  const auto maps_wanted = [&](const AlongRange& range) {
    const ExpectedRoute none;
    WantedMap map(held_, none);
    map.add_way(held_.find({kWantedTown, "road"})->layer, range, WantedFor::this_frame);
    return map.wants().maps;
  };
  EXPECT_TRUE(maps_wanted({50, 150}).empty());
  EXPECT_THAT(maps_wanted({50, 250}), ElementsAre("east"));
  held_.current_maps["east"] = {"east", "7"};
  EXPECT_TRUE(maps_wanted({50, 250}).empty());
  EXPECT_THAT(wanted({50, 250}), ::testing::Contains(Pair("far", 1)));
}

TEST_F(WantedRoads, ARouteMayPassInBothDirections) {
  const auto route = ExpectedRoute::through({in_wanted_town(900, 120), in_wanted_town(18, 120),
                                             in_wanted_town(0, 98), in_wanted_town(0, -500),
                                             in_wanted_town(1, -500), in_wanted_town(1, 98),
                                             in_wanted_town(18, 121), in_wanted_town(900, 121)});
  EXPECT_THAT(wanted({50, 150}, *route),
              ElementsAre(Pair("road", 0), Pair("right", 0), Pair("straight", 1)));
}

TEST_F(WantedRoads, ARouteIsAtLeastTwoPlaces) {
  EXPECT_FALSE(ExpectedRoute::through({in_wanted_town(0, 0)}).ok());
  EXPECT_FALSE(ExpectedRoute().leads_over(*held_.find({kWantedTown, "road"})->layer));
}

}  // namespace
}  // namespace milepost
