#include "mapper/network/road_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "mapper/network/geocentric.h"
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

NamedDrivenLines drawn_lines(const Drive& drive) { return driven_lines(drive, {}).value(); }

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
    names.reserve(segment.passes.size());
    for (const Pass& pass : segment.passes) names.push_back(drives[pass.drive].name);
    return names;
  }
};

// Segments end where they are cut.
NetworkSettings without_overlap() {
  NetworkSettings settings;
  settings.overlap_m = 0;
  return settings;
}

MadeNetwork network_of(std::vector<NamedDrivenLines> drives,
                       const NetworkSettings& settings = without_overlap()) {
  RoadNetwork network = road_network(drives, settings);
  return {std::move(drives), std::move(network)};
}

MadeNetwork network_of(const DrawnRoads& roads, const std::vector<DrawnDrive>& drives,
                       const PositionErrors& errors = {}) {
  std::vector<NamedDrivenLines> lines;
  lines.reserve(drives.size());
  for (const DrawnDrive& drive : drives) lines.push_back(drawn_lines(roads.drive(drive, errors)));
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
    double nearest_m = 2 * tolerance_m;  // at both ends together
    for (const NetworkSegment& segment : segments) {
      if (made.pass_names(segment) != truth[i].passes) continue;
      const PassLine line = made.line(segment);
      const double begins_m = distance_m(truth[i].begin, line.vertices.front());
      const double ends_m = distance_m(truth[i].end, line.vertices.back());
      if (std::max(begins_m, ends_m) > tolerance_m || begins_m + ends_m > nearest_m) continue;
      nearest_m = begins_m + ends_m;
      id_of[i] = segment.id;
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

// The network of roads drawn, divided by a line from south to north that is `east_m` from the left.
MadeNetwork divided_network(const std::string& drawing, const std::vector<DrawnDrive>& drives,
                            double east_m) {
  const DrawnRoads roads(drawing);
  NetworkSettings settings = without_overlap();
  settings.junction.border =
      Border::through(DrawnRoads::geo_of({east_m, -100}, 0), DrawnRoads::geo_of({east_m, 100}, 0))
          .value();
  std::vector<NamedDrivenLines> lines;
  lines.reserve(drives.size());
  for (const DrawnDrive& drive : drives) lines.push_back(drawn_lines(roads.drive(drive)));
  return network_of(std::move(lines), settings);
}

std::vector<std::pair<std::string, bool>> sides_of(const MadeNetwork& made) {
  std::vector<std::pair<std::string, bool>> sides;
  for (const NetworkSegment& segment : made.network.segments)
    sides.emplace_back(segment.id, segment.is_beyond_border);
  return sides;
}

TEST(RoadNetwork, ABorderCutsTheRoadsThatCrossIt) {
  using ::testing::Pair;
  constexpr const char* kRoad = "w------------------------------e";  // 124 m
  const MadeNetwork made = divided_network(kRoad, {{"a", "w e"}, {"b", "w:2 e"}, {"c", "e w"}}, 60);
  ASSERT_THAT(sides_of(made), ElementsAre(Pair("a-0", false), Pair("a-60", true), Pair("c-0", true),
                                          Pair("c-65", false)));
  EXPECT_THAT(made.pass_names(made.network.segments[1]), ElementsAre("a", "b"));
  EXPECT_THAT(made.network.segments[0].successors, ElementsAre("a-60"));
  EXPECT_THAT(made.network.segments[2].successors, ElementsAre("c-65"));
  EXPECT_THAT(sides_of(divided_network(kRoad, {{"a", "w e"}}, -50)),
              ElementsAre(Pair("a-0", true)));
}

TEST(RoadNetwork, ABorderAlongARoadDoesNotShatterIt) {
  const DrawnRoads roads("w------------------------------e");
  NetworkSettings settings = without_overlap();
  settings.junction.border =
      Border::through(DrawnRoads::geo_of({-100, 3}, 0), DrawnRoads::geo_of({300, -7}, 0)).value();
  const PositionErrors white{.white_m = 0.3};
  const MadeNetwork made = network_of({drawn_lines(roads.drive({"a", "w e"}, white))}, settings);
  EXPECT_EQ(made.network.segments.size(), 1U) << text_of(made);
}

TEST(RoadNetwork, LanesAreCutOnOneCrossSectionWhereTheBorderIsOblique) {
  const DrawnRoads roads(
      "w------------------------------------------------------------e");  // 244 m
  NetworkSettings settings = without_overlap();
  settings.junction.border =
      Border::through(DrawnRoads::geo_of({60, -30}, 0), DrawnRoads::geo_of({180, 30}, 0)).value();
  const MadeNetwork made = network_of(
      {drawn_lines(roads.drive({"a", "w e"})), drawn_lines(roads.drive({"b", "w:2 e"}))}, settings);
  ASSERT_EQ(made.network.segments.size(), 2U) << text_of(made);
  for (const NetworkSegment& segment : made.network.segments) {
    ASSERT_THAT(made.pass_names(segment), ElementsAre("a", "b"));
    EXPECT_NEAR(segment.passes[0].to_m, segment.passes[1].to_m, 5.1) << text_of(made);
  }
}

TEST(RoadNetwork, ABorderBesideAJunctionCutsThere) {
  using ::testing::Pair;
  constexpr const char* kParting = R"(
                            .---n
                        .---
    w------------------x--------------e)";
  const std::vector<DrawnDrive> drives = {{"a", "w x e"}, {"b", "w x n"}};
  const MadeNetwork whole = divided_network(kParting, drives, 1000);
  ASSERT_EQ(whole.network.segments.size(), 3U);
  const double junction_m =
      DrawnRoads::plan_of(whole.line(whole.network.segments[0]).vertices.back()).east_m;
  const MadeNetwork made = divided_network(kParting, drives, junction_m - 6);
  EXPECT_THAT(sides_of(made), ElementsAre(Pair(whole.network.segments[0].id, false),
                                          Pair(whole.network.segments[1].id, true),
                                          Pair(whole.network.segments[2].id, true)));
}

TEST(RoadNetwork, ABorderLeadsThroughItsPoints) {
  const GeoPoint from = {49, 8.4, 0};
  const LocalFrame frame(from);
  const auto is_left = [&](double east_m, double north_m) {
    const Border border = Border::through(from, frame.geo_from_enu({300, 200, 0})).value();
    return border.has_left(geocentric(frame.geo_from_enu({east_m, north_m, 0})));
  };
  EXPECT_TRUE(is_left(150, 100.5));
  EXPECT_FALSE(is_left(150, 99.5));
  EXPECT_TRUE(is_left(3000, 2001));
  EXPECT_FALSE(is_left(3000, 1999));
}

TEST(RoadNetwork, ABorderNeedsTwoPlaces) {
  EXPECT_EQ(Border::through({49, 8, 0}, {49, 8.000001, 0}).error().code, ErrorCode::invalid_input);
  EXPECT_FALSE(Border::through({49, 8, 0}, {91, 8, 0}).ok());
  EXPECT_TRUE(Border::through({49, 8, 0}, {49, 8.1, 0}).ok());
}

TEST(RoadNetwork, RoadsThatCrossAreNotLinked) {
  expect_as_drawn(kCrossing, {{"a", "w x e"}, {"b", "s x n"}}, 2);
}

TEST(RoadNetwork, Crossing) {
  expect_as_drawn(kCrossing, {{"a", "s x n"}, {"b", "s x e"}, {"c", "w x e"}, {"d", "w x n"}}, 8);
}

TEST(RoadNetwork, CrossingWithAllTurns) {
  expect_as_drawn(kCrossing,
                  {{"a", "s x n"}, {"b", "s x e"}, {"c", "s x w"}, {"d", "e x w"}, {"f", "n x e"}},
                  8);
}

TEST(RoadNetwork, ExitWithAPartingLane) {
  expect_as_drawn(R"(
    w----------x---------y----------------------e
                             .
                                 .
                                      .---s)",
                  {{"a", "w x y e"}, {"b", "w:2 x y e"}, {"c", "w:2 x:3 y s"}}, 3, 30);
}

TEST(RoadNetwork, Roundabout) {
  // Rings turn to the left. Entries and exits are 12 m apart on it.
  expect_as_drawn(R"(
                     n
                     |
                     |
                     |
                     |
                     i
                 j       h

     w----------k         g----------e

                 a       d
                     c
                     |
                     |
                     |
                     |
                     s)",
                  {{"1", "s c d g e"}, {"2", "s c d g h i n"}, {"3", "w k a c d g e"}}, 5, 14);
}

TEST(RoadNetwork, RoundaboutDrivenOneAndAQuarterTimes) {
  expect_as_drawn(R"(
                     n
                     |
                     |
                     |
                     |
                     i
                 j       h

     w----------k         g----------e

                 a       d
                     c
                     |
                     |
                     |
                     |
                     s)",
                  {{"1", "s c d g h i j k a c d g e"}}, 4, 14);
}

TEST(RoadNetwork, BridgeOverRoadIsNoJunction) {
  expect_as_drawn(kCrossing, {{"a", "s x n", 6}, {"b", "w x e"}, {"c", "s x n", 6}}, 2);
}

TEST(RoadNetwork, ParallelOneWayStreets) {
  expect_as_drawn(R"(
    n------------------------------------------m
    w------------------------------------------e)",
                  {{"a", "w e"}, {"b", "n m"}, {"c", "w e"}}, 2);
}

TEST(RoadNetwork, DualCarriageway) {
  expect_as_drawn(R"(
    n------------------------------------------m
    w------------------------------------------e)",
                  {{"a", "w:1 e"}, {"b", "m n"}, {"c", "w:2 e"}, {"d", "m:2 n"}}, 2);
}

TEST(RoadNetwork, DeadEndWithUTurn) {
  expect_as_drawn("w---------------x---------------------d", {{"a", "w x d x w"}}, 3);
  expect_as_drawn("w---------------x---------------------d",
                  {{"a", "w x d x w"}, {"b", "w x d x w"}}, 3);
}

TEST(RoadNetwork, UTurnsAtTwoPlaces) {
  expect_as_drawn("w---------------x---------------------d", {{"a", "w x d x w"}, {"b", "w x w"}},
                  6, 16);
}

TEST(RoadNetwork, Loop) {
  const char* loop = R"(
    w----------a-----m------b
               |            |
               |            |
               |            |
               |            |
               |            |
               |            |
               |            |
               d------------c)";
  expect_as_drawn(loop, {{"1", "w a m b c d a m"}}, 3);
  expect_as_drawn(loop, {{"1", "m b c d a m"}}, 1);
  expect_as_drawn(loop, {{"1", "m b c d a m b c d a m"}}, 1);  // follows itself
}

TEST(RoadNetwork, LeftTurnAcrossTheOwnLane) {
  const char* drawing = R"(
                     n
                     |
                     |
                     |
                     |
    w----------------x--------------a
                     |              |
                     |              |
                     |              |
                     |              |
                     |              |
                     |              |
                     s--------------b)";
  expect_as_drawn(drawing, {{"1", "w x a b s x n"}}, 1);
  expect_as_drawn(drawing, {{"1", "w x a b s x w"}}, 1);
}

// A street passed in lane 1, lane 2 and from lane 2 onto a ramp; lane 3 is 7 m from lane 1.
TEST(RoadNetwork, ChainOfLanesDoesNotHoldAPartingRamp) {
  expect_as_drawn(R"(
    w----------x---------y----------------------e
                             .
                                 .
                                      .---s)",
                  {{"1", "w x y e"}, {"2", "w:2 x y e"}, {"3", "w:2 x y s"}, {"4", "w:2 x:3 y s"}},
                  3, 30);
}

TEST(RoadNetwork, ABiasDoesNotJoinParallelStreets) {
  const DrawnRoads roads(R"(
    n------------------------------------------m
    w------------------------------------------e)");
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::vector<NamedDrivenLines> drives;
    for (const auto& [name, way, right_m] :
         {std::tuple{"a", "w e", 0.0}, {"b", "w e", -1.5}, {"c", "n m", 0.0}, {"d", "n m", 0.0}}) {
      drives.push_back(drawn_lines(roads.drive(
          {name, way}, {.white_m = 0.3, .slow_m = 0.3, .right_m = right_m, .seed = seed})));
    }
    const MadeNetwork made = network_of(std::move(drives));
    EXPECT_EQ(made.network.segments.size(), 2U) << text_of(made);
  }
}

TEST(RoadNetwork, WeavingLanesAreOneRoad) {
  expect_as_drawn(
      "w-------p-------q-------r-------s-------t-------e",
      {{"a", "w p:2 q:1 r:2 s:1 t e"}, {"b", "w:2 p:1 q:2 r s:1 t e"}, {"c", "w p q r s t:2 e"}},
      1);
}

// Whether a drive passes a part of an old segment, by a network that has both.
bool overlaps(const MadeNetwork& made, const std::string& drive, const MadeNetwork& old,
              const NetworkSegment& old_segment) {
  for (const NetworkSegment& segment : made.network.segments) {
    const std::vector<std::string> names = made.pass_names(segment);
    if (std::ranges::count(names, drive) == 0) continue;
    for (const Pass& pass : segment.passes) {
      for (const Pass& old_pass : old_segment.passes) {
        const double common_m =
            std::min(pass.to_m, old_pass.to_m) - std::max(pass.from_m, old_pass.from_m);
        if (made.drives[pass.drive].name == old.drives[old_pass.drive].name && common_m > 0) {
          return true;
        }
      }
    }
  }
  return false;
}

TEST(RoadNetwork, ANewDriveChangesOnlySegmentsThatItPasses) {
  const DrawnRoads roads(kCrossing);
  const std::vector<DrawnDrive> drives = {
      {"a", "s x n"}, {"b", "s x e"}, {"c", "w x e"}, {"d", "w x n"}, {"f", "n x w"}};
  std::size_t kept = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const PositionErrors errors{.white_m = 0.3, .slow_m = 0.7, .heading_deg = 1, .seed = seed};
    const MadeNetwork all = network_of(roads, drives, errors);
    std::set<std::string> ids;
    for (const NetworkSegment& segment : all.network.segments) ids.insert(segment.id);
    for (const DrawnDrive& added : drives) {
      std::vector<DrawnDrive> others;
      std::ranges::copy_if(drives, std::back_inserter(others),
                           [&](const DrawnDrive& drive) { return drive.name != added.name; });
      const MadeNetwork before = network_of(roads, others, errors);
      for (const NetworkSegment& segment : before.network.segments) {
        if (overlaps(all, added.name, before, segment)) continue;
        ++kept;
        EXPECT_TRUE(ids.contains(segment.id)) << segment.id << " without " << added.name << ":\n"
                                              << text_of(before) << "and with it:\n"
                                              << text_of(all);
      }
    }
  }
  EXPECT_GE(kept, 100U);
}

TEST(RoadNetwork, ADriveElsewhereChangesNothing) {
  const DrawnRoads roads(R"(
    w------------------x--------------e
                       |
                       |
                       s

                                              n----------------------m)");
  const std::vector<DrawnDrive> drives = {{"b", "w x e"}, {"c", "w x s"}};
  const PositionErrors errors{.white_m = 0.3, .slow_m = 0.7, .heading_deg = 1};
  const std::string before = text_of(network_of(roads, drives, errors));
  const std::string after =
      text_of(network_of(roads, {drives[0], drives[1], {"a", "n m"}}, errors));
  EXPECT_THAT(after, ::testing::EndsWith(before));
  EXPECT_THAT(after, ::testing::StartsWith("a-0 "));
}

TEST(RoadNetwork, IdsAreValidAndTellDrivesApart) {
  EXPECT_EQ(segment_id_of("morning", 135), "morning-135");
  const std::string long_name(64, 'x');
  EXPECT_TRUE(is_segment_id(segment_id_of(long_name, 12345)));
  EXPECT_NE(segment_id_of(long_name, 5), segment_id_of(long_name.substr(1) + "y", 5));
}

TEST(RoadNetwork, ALineBeginsAndEndsAtItsCuts) {
  const DrawnRoads roads("w-----------------------------e");
  const NamedDrivenLines drive = drawn_lines(roads.drive({"a", "w e"}));
  const RouteLine& driven = drive.lines[0].line;
  const PassLine line = line_of({0, 0, 20, 45}, driven);
  EXPECT_EQ(line.vertices.front(), driven.point_at(20));
  EXPECT_EQ(line.vertices.back(), driven.point_at(45));
  EXPECT_EQ(line.along_m.front(), 0);
  EXPECT_DOUBLE_EQ(line.along_m.back(), 25);
  EXPECT_EQ(line.vertices.size(), line.along_m.size());
  EXPECT_EQ(line.vertices.size(), 2U + 12);
  for (std::size_t i = 1; i < line.vertices.size(); ++i) {
    EXPECT_NEAR(geodesic_distance_m(line.vertices[i - 1], line.vertices[i]),
                line.along_m[i] - line.along_m[i - 1], 1e-3);
  }
}

// A grid of crossings 112 m apart, with a place in the middle of each street between them.
constexpr int kGridSide = 4;
constexpr const char* kPlaces = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";

char crossing_of(int row, int column) { return kPlaces[row * kGridSide + column]; }
char middle_of(int row, int column, bool down) {
  return kPlaces[16 + (down ? 12 + row * kGridSide + column : row * (kGridSide - 1) + column)];
}

std::string grid_drawing() {
  std::string drawing;
  for (int row = 0; row < kGridSide; ++row) {
    std::string across;
    std::string down;
    for (int column = 0; column < kGridSide; ++column) {
      across += crossing_of(row, column);
      if (column + 1 < kGridSide) {
        across.append(13, '-').append({middle_of(row, column, false)}).append(13, '-');
      }
      if (row + 1 < kGridSide) down.append({middle_of(row, column, true)}).append(27, ' ');
    }
    drawing.append(across).append(7, '\n').append(down).append(7, '\n');
  }
  return drawing;
}

// Takes turns at random, from the middle of a street to that of another, some 2 km.
std::string random_way(std::mt19937& random) {
  const auto below = [&](unsigned limit) { return static_cast<int>(random() % limit); };
  int row = below(kGridSide);
  int column = below(kGridSide);
  int last_row = -1;
  int last_column = -1;
  std::string way;
  for (int step = 0; step < 20;) {
    constexpr std::array<std::pair<int, int>, 4> kSteps = {{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};
    const auto [down, right] = kSteps[static_cast<std::size_t>(below(4))];
    const int next_row = row + down;
    const int next_column = column + right;
    const bool outside = std::clamp(next_row, 0, kGridSide - 1) != next_row ||
                         std::clamp(next_column, 0, kGridSide - 1) != next_column;
    if (outside || (next_row == last_row && next_column == last_column)) continue;
    if (step > 0) way.append({crossing_of(row, column), ' '});
    way.append({middle_of(std::min(row, next_row), std::min(column, next_column), down != 0), ' '});
    last_row = std::exchange(row, next_row);
    last_column = std::exchange(column, next_column);
    ++step;
  }
  return way;
}

std::vector<DrawnDrive> random_drives(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<DrawnDrive> drives;
  for (std::size_t i = 0; i < count; ++i) {
    drives.push_back({std::string(1, static_cast<char>('a' + i)), random_way(random)});
  }
  return drives;
}

// Right turns are the shortest segments, and noise rarely makes one shorter than a junction: of
// 80 such networks, two lack one segment of some 75.
TEST(RoadNetwork, RandomDrivesInAGridOfStreets) {
  const DrawnRoads roads(grid_drawing());
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<DrawnDrive> drives = random_drives(6, seed);
    const std::vector<TrueSegment> truth = roads.true_segments(drives);
    expect_as_drawn(network_of(roads, drives), truth);
    expect_as_drawn(network_of(roads, drives, {.white_m = 0.3, .heading_deg = 1}), truth);
  }
}

// An elevated road runs over 200 m of another, or they join and split.
constexpr const char* kStacked = R"(
    n----.                                                  .------m
           .                                             .
    w-----------x--------------------------------------y-----------e)";

TEST(RoadNetwork, StackedRoadsWithAltitudesAreTwo) {
  expect_as_drawn(kStacked, {{"a", "w e", 100}, {"b", "w e", 100}}, 1);
  const DrawnRoads roads(kStacked);
  const MadeNetwork made = network_of(roads, {{"a", "w x y e", 100}, {"b", "n x y m", 106}});
  EXPECT_EQ(made.network.segments.size(), 2U) << text_of(made);
  EXPECT_THAT(made.network.findings, IsEmpty());
  const MadeNetwork level = network_of(roads, {{"a", "w x y e", 100}, {"b", "n x y m", 101}});
  EXPECT_EQ(level.network.segments.size(), 5U) << text_of(level);
}

TEST(RoadNetwork, StackedRoadsWithoutAltitudesStayApartAndAreTold) {
  const DrawnRoads roads(kStacked);
  const MadeNetwork made = network_of(roads, {{"b", "n x y m"}, {"a", "w x y e"}});
  EXPECT_EQ(made.network.segments.size(), 2U) << text_of(made);
  ASSERT_EQ(made.network.findings.size(), 1U);
  EXPECT_THAT(made.network.findings[0].where, ::testing::HasSubstr("drive 'a' from metre "));
  EXPECT_THAT(made.network.findings[0].what, ::testing::HasSubstr("kept apart"));
}

TEST(RoadNetwork, ADriveThatChangesBetweenRoadsShowsThatTheyAreOne) {
  expect_as_drawn(kStacked, {{"a", "w x y e"}, {"b", "n x y m"}, {"c", "w x y m"}}, 5, 40);
}

TEST(RoadNetwork, ImagesDecideOnStackedRoads) {
  const DrawnRoads roads(kStacked);
  const MadeNetwork made = network_of(roads, {{"b", "n x y m"}, {"a", "w x y e"}});
  for (const bool same : {true, false}) {
    int asked = 0;
    const RoadNetwork network =
        road_network(made.drives, {}, first_pass, [&](const Pass& a, const Pass& b) {
          ++asked;
          EXPECT_EQ(made.drives[a.drive].name, "a");
          EXPECT_EQ(made.drives[b.drive].name, "b");
          return std::optional(same);
        });
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(network.segments.size(), same ? 5U : 2U);
    ASSERT_EQ(network.findings.size(), same ? 0U : 1U);
    for (const Finding& finding : network.findings)
      EXPECT_THAT(finding.what, ::testing::HasSubstr("by their images"));
  }
}

// In a city, drives turn into a street that they share, and out of it.
TEST(RoadNetwork, StreetsThatDrivesTurnIntoAreNotStacked) {
  expect_as_drawn(R"(
         n                                           m
         |                                           |
         |                                           |
         |                                           |
         |                                           |
    w----x-------------------------------------------y-----------e)",
                  {{"a", "w x y e"}, {"b", "n x y m"}}, 5);
}

TEST(RoadNetwork, TheReferenceIsTheOneChosen) {
  const DrawnRoads roads("w---------x-------------y-----------e");
  const MadeNetwork made = network_of(roads, {{"a", "w x y e"}, {"b", "w x y e"}});
  const RoadNetwork network = road_network(
      made.drives, {}, [](const std::vector<Pass>& passes) { return passes.size() - 1; });
  ASSERT_EQ(network.segments.size(), 1U);
  EXPECT_EQ(network.segments[0].id, "b-0");
  EXPECT_EQ(network.segments[0].reference_pass().drive, 1U);
}

TEST(RoadNetwork, SegmentsRunOnBeyondTheirCutsButNotBeyondTheDrive) {
  const DrawnRoads roads(R"(
                            .---n
                        .---
    w------------------x--------------e)");
  const std::vector<DrawnDrive> drives = {{"a", "w x e"}, {"b", "w x n"}};
  const MadeNetwork cut = network_of(roads, drives);
  const RoadNetwork network = road_network(cut.drives, {});
  ASSERT_EQ(network.segments.size(), 3U);
  for (std::size_t i = 0; i < network.segments.size(); ++i) {
    const NetworkSegment& whole = network.segments[i];
    EXPECT_EQ(whole.id, cut.network.segments[i].id);
    EXPECT_EQ(whole.successors, cut.network.segments[i].successors);
    const double more_m =
        whole.reference_pass().to_m - cut.network.segments[i].reference_pass().to_m;
    EXPECT_EQ(more_m, whole.successors.empty() ? 0 : NetworkSettings().overlap_m);
  }
}

TEST(RoadNetwork, TheReferencesOwnSuccessorComesFirst) {
  const DrawnRoads roads(R"(
                            .---n
                        .---
    w------------------x--------------e)");
  for (const auto& [first, second] : {std::pair{"w x e", "w x n"}, {"w x n", "w x e"}}) {
    const MadeNetwork made = network_of(roads, {{"a", first}, {"Z", second}});
    const RoadNetwork network = road_network(
        made.drives, {}, [](const std::vector<Pass>& passes) { return passes.size() - 1; });
    ASSERT_EQ(network.segments.size(), 3U);
    const auto shared = std::ranges::find(network.segments, "a-0", &NetworkSegment::id);
    ASSERT_NE(shared, network.segments.end());
    ASSERT_EQ(shared->successors.size(), 2U);
    EXPECT_TRUE(shared->successors[0].starts_with("a-"));
    EXPECT_TRUE(shared->successors[1].starts_with("Z-"));
  }
}

// Nothing shows where the vehicle went meanwhile.
TEST(RoadNetwork, NoLinkLeadsAcrossAPause) {
  const DrawnRoads roads("w---------x-------------y-----------e");
  Drive drive = roads.drive({"a", "w x y e"});
  drive.frames.erase(drive.frames.begin() + 30, drive.frames.begin() + 50);
  const MadeNetwork alone = network_of({drawn_lines(drive)});
  ASSERT_EQ(alone.network.segments.size(), 2U);
  EXPECT_THAT(alone.network.segments[0].successors, IsEmpty());
  EXPECT_THAT(alone.network.segments[1].successors, IsEmpty());
  EXPECT_EQ(alone.network.findings.size(), 1U);
  // Another drive closes it.
  const MadeNetwork both =
      network_of({drawn_lines(drive), drawn_lines(roads.drive({"b", "w x y e"}))});
  EXPECT_EQ(both.network.segments.size(), 3U) << text_of(both);
  EXPECT_THAT(both.network.segments[0].successors, ElementsAre("b-60")) << text_of(both);
}

}  // namespace
}  // namespace milepost
