#include "tests/simulator/city.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tests/simulator/city_runs.h"
#include "tests/simulator/city_tours.h"
#include "tests/simulator/motion.h"

namespace milepost::simulator {
namespace {

constexpr std::array<std::uint64_t, 3> kCitySeeds = {1, 2, 3};

const City& full_city(std::uint64_t seed = 1) {
  static std::map<std::uint64_t, City> cities;
  const auto found = cities.find(seed);
  if (found != cities.end()) return found->second;
  return cities.emplace(seed, make_city(seed, CityPlan::full)).first->second;
}

const City& small_city() {
  static const City city = make_city(1, CityPlan::small);
  return city;
}

std::set<Turn> mapped_turns(const City& city) {
  std::set<Turn> turns;
  for (const CityDrive& drive : city.drives) {
    if (drive.is_tour) continue;
    for (const Turn& turn : turns_of(drive)) turns.insert(turn);
  }
  return turns;
}

std::vector<const CityDrive*> tours_in(const City& city) {
  std::vector<const CityDrive*> tours;
  for (const CityDrive& drive : city.drives) {
    if (drive.is_tour) tours.push_back(&drive);
  }
  return tours;
}

double way_m(const City& city, const std::string& name) {
  return city.network.route(name)->path.length_m();
}

// Of the edges that a drive passes from begin to end.
std::set<std::size_t> whole_edges(const CityDrive& drive) {
  std::set<std::size_t> edges;
  for (std::size_t i = 0; i < drive.passes.size(); ++i) {
    const bool is_cut =
        (i == 0 && drive.skipped_m > 0) || (i + 1 == drive.passes.size() && drive.left_out_m > 0);
    if (!is_cut) edges.insert(drive.passes[i].edge);
  }
  return edges;
}

TEST(City, HasEveryKindOfJunctionAndThreeKilometresOfRoad) {
  for (const std::uint64_t seed : kCitySeeds) {
    const City& city = full_city(seed);
    std::map<JunctionKind, int> kinds;
    for (const Junction& junction : city.junctions) ++kinds[junction.kind];
    EXPECT_EQ(kinds[JunctionKind::crossing], 4);
    EXPECT_EQ(kinds[JunctionKind::tee], 5);
    for (const JunctionKind kind : {JunctionKind::split, JunctionKind::join, JunctionKind::exit,
                                    JunctionKind::roundabout, JunctionKind::dead_end}) {
      EXPECT_EQ(kinds[kind], 1) << name_of(kind);
    }
    double roads_m = 0;
    for (const Road& road : city.network.roads) roads_m += road.path.length_m();
    EXPECT_GT(roads_m, 3000);
    EXPECT_LT(roads_m, 5000);
  }
}

TEST(City, TheSmallOneHasTwoJunctionsAndThreeDrives) {
  const City& city = small_city();
  const auto tees =
      std::count_if(city.junctions.begin(), city.junctions.end(),
                    [](const Junction& junction) { return junction.kind == JunctionKind::tee; });
  EXPECT_EQ(tees, 2);
  EXPECT_EQ(city.drives.size(), 3U);
  EXPECT_EQ(tours_in(city).size(), 1U);
  double roads_m = 0;
  for (const Road& road : city.network.roads) roads_m += road.path.length_m();
  EXPECT_NEAR(roads_m, 400, 60);
}

TEST(City, AFleetDrivesOneWayInEitherLane) {
  const City city = make_city(1, CityPlan::fleet);
  ASSERT_EQ(city.drives.size(), 7U);
  ASSERT_EQ(tours_in(city).size(), 1U);
  std::set<int> lanes;
  for (const CityDrive& drive : city.drives) {
    ASSERT_EQ(drive.passes.size(), city.drives.front().passes.size());
    for (std::size_t i = 0; i < drive.passes.size(); ++i)
      EXPECT_EQ(drive.passes[i].edge, city.drives.front().passes[i].edge);
    lanes.insert(drive.passes[1].lane);
  }
  EXPECT_EQ(lanes, (std::set<int>{1, 2}));
}

TEST(City, AnotherSeedGivesAnotherCityOfTheSamePlan) {
  const City& one = full_city(1);
  const City& other = full_city(2);
  ASSERT_EQ(one.edges.size(), other.edges.size());
  int different = 0;
  for (std::size_t i = 0; i < one.edges.size(); ++i) {
    EXPECT_EQ(one.edges[i].name, other.edges[i].name);
    different += std::abs(one.edges[i].middle.length_m() - other.edges[i].middle.length_m()) > 0.1;
  }
  EXPECT_GT(different, 20);
}

TEST(City, EveryEdgeIsNamedOnceAndJoinsTwoJunctions) {
  for (const City* city : {&full_city(), &small_city()}) {
    std::set<std::string> names;
    for (const Edge& edge : city->edges) {
      EXPECT_TRUE(names.insert(edge.name).second) << edge.name;
      EXPECT_GT(edge.middle.length_m(), 15) << edge.name;
      const auto off_m = [&](const Directed& end, std::size_t junction) {
        return cv::norm(end.at - city->junctions[junction].at);
      };
      EXPECT_LT(off_m(edge.middle.start(), edge.from), 32) << edge.name;
      EXPECT_LT(off_m(edge.middle.end(), edge.to), 32) << edge.name;
    }
  }
}

TEST(City, TheParallelStreetsAreEightMetresApart) {
  const City& city = full_city();
  const auto middle_of = [&](const std::string& name) {
    const auto edge = std::find_if(city.edges.begin(), city.edges.end(),
                                   [&](const Edge& each) { return each.name == name; });
    EXPECT_FALSE(edge->has_oncoming);
    return edge->middle;
  };
  const Path upper = middle_of("upper-quay.1+");
  const Path lower = middle_of("lower-quay.1+");
  EXPECT_GT(upper.length_m(), 150);
  for (double along = 1; along < upper.length_m() - 1; along += 5) {
    EXPECT_NEAR(std::abs(lower.place_of(upper.position_at({along, 0})).lateral_m), 8, 0.01);
  }
}

TEST(City, ToursTakeEveryMappedTurnAndOnlyTheLastTakesAnother) {
  for (const std::uint64_t seed : kCitySeeds) {
    const City& city = full_city(seed);
    const std::set<Turn> mapped = mapped_turns(city);
    const auto tours = tours_in(city);
    std::set<Turn> taken;
    for (const CityDrive* tour : tours) {
      int strange = 0;
      for (const Turn& turn : turns_of(*tour)) {
        taken.insert(turn);
        strange += !mapped.contains(turn);
      }
      EXPECT_EQ(strange, tour == tours.back() ? 2 : 0) << tour->name;
    }
    for (const Turn& turn : mapped) {
      EXPECT_TRUE(taken.contains(turn))
          << city.edges[turn.first].name << " to " << city.edges[turn.second].name;
    }
  }
  for (const Turn& turn : mapped_turns(small_city())) {
    EXPECT_THAT(turns_of(*tours_in(small_city()).front()), ::testing::Contains(turn));
  }
}

TEST(City, ToursStayOnWhatIsMappedInFull) {
  for (const City* city : {&full_city(), &small_city()}) {
    std::set<std::size_t> mapped;
    for (const CityDrive& drive : city->drives) {
      if (!drive.is_tour) mapped.merge(whole_edges(drive));
    }
    const auto tours = tours_in(*city);
    for (const CityDrive* tour : tours) {
      if (city == &full_city() && tour == tours.back()) continue;  // it leaves the map
      for (const Pass& pass : tour->passes) {
        EXPECT_TRUE(mapped.contains(pass.edge)) << city->edges[pass.edge].name;
      }
    }
  }
}

TEST(City, TheLargestTourHasAboutFiveKilometres) {
  double longest_m = 0;
  for (const CityDrive* tour : tours_in(full_city())) {
    longest_m = std::max(longest_m, way_m(full_city(), tour->name));
  }
  EXPECT_GT(longest_m, 4500);
  EXPECT_LT(longest_m, 5200);
}

TEST(City, DrivesOverlapInPartsAndGoDifferentWays) {
  const City& city = full_city();
  std::map<std::size_t, int> passes;  // drives over an edge
  int drives = 0;
  for (const CityDrive& drive : city.drives) {
    if (drive.is_tour) continue;
    ++drives;
    std::set<std::size_t> edges;
    for (const Pass& pass : drive.passes) edges.insert(pass.edge);
    for (const std::size_t edge : edges) ++passes[edge];
  }
  EXPECT_EQ(drives, 6);
  int shared = 0, alone = 0, both_ways = 0;
  for (const auto& [edge, count] : passes) {
    shared += count > 1;
    alone += count == 1;
    std::string back = city.edges[edge].name;
    back.back() = back.back() == '+' ? '-' : '+';
    both_ways += std::any_of(passes.begin(), passes.end(), [&](const auto& other) {
      return city.edges[other.first].name == back;
    });
  }
  EXPECT_GE(shared, 12);
  EXPECT_GE(alone, 8);
  EXPECT_GE(both_ways, 12);
}

TEST(City, DrivesDifferInLaneLightAndTraffic) {
  const City& city = full_city();
  std::set<std::pair<std::string, int>> lanes;
  std::set<double> suns;
  int with_traffic = 0, maps = 0;
  for (const CityDrive& drive : city.drives) {
    if (drive.is_tour) continue;
    for (const Pass& pass : drive.passes) lanes.emplace(city.edges[pass.edge].name, pass.lane);
  }
  for (const RunPlan& run : city_runs(city, 1e9)) {
    if (run.spacing_m == 0) continue;
    ++maps;
    suns.insert(run.light.sun_azimuth_deg);
    with_traffic += run.has_oncoming || run.has_truck_ahead;
  }
  EXPECT_TRUE(lanes.contains({"avenue-west.1+", 2}) && lanes.contains({"avenue-east.1+", 1}));
  EXPECT_GE(suns.size(), 4U);
  EXPECT_GT(with_traffic, 0);
  EXPECT_LT(with_traffic, maps);
}

TEST(City, RoutesAreSmoothAndDrivable) {
  constexpr double kStepM = 0.2;
  constexpr double kTightestM = 6;
  for (const City* city : {&full_city(1), &full_city(2), &full_city(3), &small_city()}) {
    for (const Route& route : city->network.routes) {
      for (double along = 0; along + kStepM < route.path.length_m(); along += kStepM) {
        const cv::Vec2d step =
            route.path.position_at({along + kStepM, 0}) - route.path.position_at({along, 0});
        ASSERT_NEAR(cv::norm(step), kStepM, 1e-3) << route.name << " at " << along;
        const double turn = std::remainder(
            route.path.heading_rad_at(along + kStepM) - route.path.heading_rad_at(along),
            2 * std::numbers::pi);
        ASSERT_LE(std::abs(turn), kStepM / kTightestM + 1e-6) << route.name << " at " << along;
      }
    }
  }
}

TEST(City, RoutesFollowTheLanesThatTheirSpansState) {
  for (const City* city : {&full_city(), &small_city()}) {
    for (const Route& route : city->network.routes) {
      for (double along = 0; along < route.path.length_m(); along += 1) {
        const RouteSpan& span = route.span_at(along);
        const auto edge = std::find_if(city->edges.begin(), city->edges.end(),
                                       [&](const Edge& each) { return each.name == span.road; });
        if (span.lane == 0) {
          EXPECT_TRUE(std::any_of(city->junctions.begin(), city->junctions.end(),
                                  [&](const Junction& each) { return each.name == span.road; }))
              << span.road;
          continue;
        }
        ASSERT_NE(edge, city->edges.end()) << span.road;
        const RoadPlace place = edge->middle.place_of(route.path.position_at({along, 0}));
        // In a lane change by up to half of a lane.
        ASSERT_NEAR(place.lateral_m, edge->lane_offset_m(span.lane), kLaneM + 0.01)
            << route.name << " at " << along << " on " << span.road;
      }
    }
  }
}

TEST(City, RoutesStayOnCarriageways) {
  const City& city = full_city();
  for (const Route& route : city.network.routes) {
    for (double along = 0; along < route.path.length_m(); along += 1) {
      const cv::Vec2d at = route.path.position_at({along, 0});
      double nearest_m = 1e9;
      for (const Road& road : city.network.roads) {
        nearest_m =
            std::min(nearest_m, std::abs(road.path.place_of(at).lateral_m) - road.half_width_m);
      }
      ASSERT_LT(nearest_m, 3) << route.name << " at " << along;  // rounded corners
    }
  }
}

TEST(City, TheBridgeIsAboveTheRoadThatItCrosses) {
  for (const std::uint64_t seed : kCitySeeds) {
    const City& city = full_city(seed);
    ASSERT_EQ(city.network.bridges.size(), 1U);
    const Bridge& bridge = city.network.bridges.front();
    int above = 0, below = 0;
    double lowest_above = 1e9, highest_below = -1e9;
    for (const Route& route : city.network.routes) {
      for (double along = 0; along < route.path.length_m(); along += 1) {
        const cv::Vec2d at = route.path.position_at({along, 0});
        if (cv::norm(at - (bridge.south_west + bridge.north_east) * 0.5) > 6) continue;
        const double height = route.height_m(city.network.terrain, along, at);
        if (route.span_at(along).road.starts_with("bridge-street")) {
          ++above;
          lowest_above = std::min(lowest_above, height);
        } else {
          EXPECT_TRUE(route.span_at(along).road.starts_with("market-street"));
          ++below;
          highest_below = std::max(highest_below, height);
        }
      }
    }
    EXPECT_GT(above, 10);
    EXPECT_GT(below, 10);
    EXPECT_GT(lowest_above - highest_below, 5.4);
  }
}

TEST(City, RampsAreNoSteeperThanStreets) {
  for (const std::uint64_t seed : kCitySeeds) {
    const City& city = full_city(seed);
    for (const Route& route : city.network.routes) {
      const auto height = [&](double along) {
        return route.height_m(city.network.terrain, along, route.path.position_at({along, 0}));
      };
      for (double along = 0; along + 1 < route.path.length_m(); along += 1) {
        ASSERT_LT(std::abs(height(along + 1) - height(along)), 0.14)
            << route.name << " at " << along;
      }
    }
  }
}

TEST(City, OneDriveGoesOneAndAQuarterTimesAroundTheRoundabout) {
  const City& city = full_city();
  const cv::Vec2d middle = city.junctions[city.junction("ring")].at;
  double most_deg = 0;
  for (const CityDrive& drive : city.drives) {
    if (drive.is_tour) continue;
    const Path& path = city.network.route(drive.name)->path;
    double turned_rad = 0;
    for (double along = 0; along + 1 < path.length_m(); along += 1) {
      const cv::Vec2d at = path.position_at({along, 0}) - middle;
      const cv::Vec2d next = path.position_at({along + 1, 0}) - middle;
      if (cv::norm(at) < 20) {
        turned_rad +=
            std::asin((at[0] * next[1] - at[1] * next[0]) / cv::norm(at) / cv::norm(next));
      }
    }
    most_deg = std::max(most_deg, turned_rad * kDegPerRad);
  }
  EXPECT_NEAR(most_deg, 360 + 90, 40);
}

}  // namespace
}  // namespace milepost::simulator
