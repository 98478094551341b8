#include "mapper/network/road_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "schema/base/ids.h"
#include "tests/mapper/network/drawn_roads.h"

namespace milepost {
namespace {

using testing::DrawnDrive;
using testing::DrawnRoads;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::PlanPoint;
using testing::PositionErrors;
using testing::TrueSegment;

NamedDrivenLines lines_of(const Drive& drive) { return driven_lines(drive, {}).value(); }

// A network with the lines that it was made of.
struct MadeNetwork {
  std::vector<NamedDrivenLines> drives;
  RoadNetwork network;

  PassLine line(const NetworkSegment& segment) const {
    const Pass& pass = segment.reference_pass();
    return line_of(pass, drives[pass.drive].lines[pass.stretch].line);
  }
  std::vector<std::string> pass_names(const NetworkSegment& segment) const {
    std::vector<std::string> names;
    for (const Pass& pass : segment.passes) names.push_back(drives[pass.drive].name);
    return names;
  }
};

MadeNetwork network_of(std::vector<NamedDrivenLines> drives, const NetworkSettings& settings = {}) {
  RoadNetwork network = road_network(drives, settings);
  return {std::move(drives), std::move(network)};
}

MadeNetwork network_of(const DrawnRoads& roads, const std::vector<DrawnDrive>& drives,
                       const PositionErrors& errors = {}) {
  std::vector<NamedDrivenLines> lines;
  for (const DrawnDrive& drive : drives) lines.push_back(lines_of(roads.drive(drive, errors)));
  return network_of(std::move(lines));
}

// One line a segment: "a-0 [a b] 0,50 to 100,50 -> a-105".
std::string text_of(const MadeNetwork& made) {
  std::ostringstream text;
  const auto add_point = [&](const GeoPoint& geo) {
    const PlanPoint point = DrawnRoads::plan_of(geo);
    text << std::lround(point.east_m) << ',' << std::lround(point.north_m);
  };
  for (const NetworkSegment& segment : made.network.segments) {
    text << segment.id << " [";
    for (const Pass& pass : segment.passes) {
      text << ' ' << made.drives[pass.drive].name << ' ' << std::lround(pass.from_m) << ".."
           << std::lround(pass.to_m);
    }
    text << " ] ";
    const PassLine line = made.line(segment);
    add_point(line.vertices.front());
    text << " to ";
    add_point(line.vertices.back());
    text << " ->";
    for (const std::string& id : segment.successors) text << ' ' << id;
    text << '\n';
  }
  return text.str();
}

double distance_m(const PlanPoint& a, const GeoPoint& b) {
  const PlanPoint plan = DrawnRoads::plan_of(b);
  return std::hypot(a.east_m - plan.east_m, a.north_m - plan.north_m);
}

// Holds a network against the true graph: segments, their passes, ends, links and ids.
void expect_as_drawn(const MadeNetwork& made, const std::vector<TrueSegment>& truth,
                     double tolerance_m = 12) {
  SCOPED_TRACE(text_of(made));
  const std::vector<NetworkSegment>& segments = made.network.segments;
  EXPECT_EQ(segments.size(), truth.size());
  std::vector<std::string> id_of(truth.size(), "none");
  std::set<std::string> ids;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (const NetworkSegment& segment : segments) {
      const PassLine line = made.line(segment);
      const bool fits = made.pass_names(segment) == truth[i].passes &&
                        distance_m(truth[i].begin, line.vertices.front()) < tolerance_m &&
                        distance_m(truth[i].end, line.vertices.back()) < tolerance_m;
      if (fits) id_of[i] = segment.id;
    }
    EXPECT_TRUE(ids.insert(id_of[i]).second);
    EXPECT_NE(id_of[i], "none") << "no segment from " << truth[i].begin.east_m << ','
                                << truth[i].begin.north_m << " to " << truth[i].end.east_m << ','
                                << truth[i].end.north_m << " passed by "
                                << ::testing::PrintToString(truth[i].passes);
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto segment = std::ranges::find(segments, id_of[i], &NetworkSegment::id);
    if (segment == segments.end()) continue;
    std::set<std::string> successors;
    for (const std::size_t next : truth[i].successors) successors.insert(id_of[next]);
    EXPECT_EQ(std::set<std::string>(segment->successors.begin(), segment->successors.end()),
              successors)
        << "after " << id_of[i];
    EXPECT_TRUE(segment->id.starts_with(truth[i].passes.front() + "-")) << segment->id;
    EXPECT_TRUE(is_segment_id(segment->id));
  }
}

// As drawn: with exact positions, with noise, and with noise and drift, in any order of drives.
void expect_as_drawn(const std::string& drawing, std::vector<DrawnDrive> drives,
                     std::size_t segments, double tolerance_m = 12) {
  const DrawnRoads roads(drawing);
  const std::vector<TrueSegment> truth = roads.true_segments(drives);
  EXPECT_EQ(truth.size(), segments) << "the drawing says otherwise";
  expect_as_drawn(network_of(roads, drives), truth, tolerance_m);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const PositionErrors white{.white_m = 0.3, .heading_deg = 1, .seed = seed};
    expect_as_drawn(network_of(roads, drives, white), truth, tolerance_m);
    const PositionErrors slow{.white_m = 0.3, .slow_m = 0.7, .heading_deg = 1, .seed = seed};
    expect_as_drawn(network_of(roads, drives, slow), truth, tolerance_m);
  }
  const auto by_name = [](const DrawnDrive& a, const DrawnDrive& b) { return a.name < b.name; };
  std::sort(drives.begin(), drives.end(), by_name);
  const PositionErrors errors{.white_m = 0.3, .slow_m = 0.7, .heading_deg = 1, .seed = 9};
  const std::string in_order = text_of(network_of(roads, drives, errors));
  while (std::next_permutation(drives.begin(), drives.end(), by_name)) {
    EXPECT_EQ(text_of(network_of(roads, drives, errors)), in_order);
  }
}

TEST(RoadNetwork, OneDriveIsOneSegment) {
  expect_as_drawn("w-----------------------------e", {{"a", "w e"}}, 1);
}

TEST(RoadNetwork, TwoDrivesOnOneRoadAreOneSegment) {
  expect_as_drawn("w-----------------------------e", {{"a", "w e"}, {"b", "w e"}}, 1);
}

TEST(RoadNetwork, PartsThatOneDriveAlonePassedAreSegments) {
  expect_as_drawn("w---------x-------------y-----------e",
                  {{"a", "w x y"}, {"b", "x y e"}, {"c", "w x y e"}}, 3);
}

TEST(RoadNetwork, NeighbouringLanesAreOneRoad) {
  expect_as_drawn("w----------x---------y----------e",
                  {{"a", "w x y e"}, {"b", "w:2 x y e"}, {"c", "w x:2 y:1 e"}}, 1);
}

TEST(RoadNetwork, OppositeDirectionsAreTwo) {
  expect_as_drawn("w-----------------------------e", {{"a", "w e"}, {"b", "e w"}}, 2);
}

TEST(RoadNetwork, Split) {
  expect_as_drawn(R"(
                            .---n
                        .---
    w------------------x--------------e)",
                  {{"a", "w x e"}, {"b", "w x n"}}, 3, 20);
}

TEST(RoadNetwork, Join) {
  expect_as_drawn(R"(
    n---.
         ---.
    w------------x--------------------e)",
                  {{"a", "w x e"}, {"b", "n x e"}}, 3, 20);
}

TEST(RoadNetwork, TJunction) {
  expect_as_drawn(R"(
    w----------------x----------------e
                     |
                     |
                     |
                     |
                     |
                     |
                     s)",
                  {{"a", "w x e"}, {"b", "w x s"}, {"c", "s x e"}, {"d", "e x w"}, {"f", "e x s"}},
                  9);
}

constexpr const char* kCrossing = R"(
                     n
                     |
                     |
                     |
                     |
                     |
                     |
    w----------------x----------------e
                     |
                     |
                     |
                     |
                     |
                     |
                     s)";

TEST(RoadNetwork, RoadsThatCrossAreNotLinked) {
  expect_as_drawn(kCrossing, {{"a", "w x e"}, {"b", "s x n"}}, 2);
}

TEST(RoadNetwork, Crossing) {
  expect_as_drawn(kCrossing, {{"a", "s x n"}, {"b", "s x e"}, {"c", "w x e"}, {"d", "w x n"}}, 8);
}

}  // namespace
}  // namespace milepost
