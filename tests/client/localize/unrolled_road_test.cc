// Segments around the current one in its arc length.
#include "client/localize/unrolled_road.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;

constexpr double kDegreeM = 111229;  // of latitude, at 49 degrees
const MapVersion kTown = {"town", "1"};

// A line to the north between two distances from 49 degrees.
RouteLine north(double from_m, double to_m) {
  return *RouteLine::from_vertices(
      {{49 + from_m / kDegreeM, 8.4, 110}, {49 + to_m / kDegreeM, 8.4, 110}});
}

// A -> B -> D, A -> C -> D, of lines that overlap by 5 m; E -> B.
class Town : public ::testing::Test {
 protected:
  Town() {
    add("A", 0, 105, {"B", "C"});
    add("B", 100, 155, {"D"});
    add("C", 100, 155, {"D"});
    add("D", 150, 250, {});
    add("E", 40, 105, {"B"});
  }

  void add(const std::string& id, double from_m, double to_m,
           const std::vector<std::string>& successors, const MapVersion& version = kTown) {
    SegmentLayer layer = *testing::layer_of({version, id}, north(from_m, to_m), {}, {});
    for (const std::string& successor : successors) layer.successors.push_back({successor, "town"});
    HeldSegment held;
    held.layer = std::make_shared<const SegmentLayer>(std::move(layer));
    held_.segments[{version, id}] = std::make_shared<const HeldSegment>(held);
  }

  std::shared_ptr<const SegmentLayer> layer(const std::string& id) const {
    return held_.find({kTown, id})->layer;
  }

  struct Listed {
    std::string id;
    RoadSide side;
    int junctions;
    bool is_main_way;

    friend bool operator==(const Listed&, const Listed&) = default;
  };

  std::vector<Listed> around(const std::string& current, const AlongRange& range) {
    std::vector<Listed> listed;
    for (const UnrolledSegment& segment : unrolled_road(held_, layer(current), range)) {
      offsets_m_[segment.layer->key.segment] = segment.offset_m;
      listed.push_back(
          {segment.layer->key.segment, segment.side, segment.junctions, segment.is_main_way});
    }
    return listed;
  }

  HeldMap held_;
  std::map<std::string, double> offsets_m_;
};

TEST_F(Town, AllBranchesLieAhead) {
  EXPECT_THAT(
      around("A", {90, 200}),
      ElementsAre(Listed{"A", RoadSide::current, 0, true}, Listed{"B", RoadSide::ahead, 1, true},
                  Listed{"C", RoadSide::ahead, 1, false}, Listed{"D", RoadSide::ahead, 2, true},
                  Listed{"E", RoadSide::beside, 2, true}));
  EXPECT_NEAR(offsets_m_["B"], 100, 0.05);
  EXPECT_NEAR(offsets_m_["D"], 150, 0.05);
}

TEST_F(Town, WhatIsOutOfRangeIsNotListed) {
  EXPECT_THAT(around("A", {0, 50}), ElementsAre(Listed{"A", RoadSide::current, 0, true}));
}

TEST_F(Town, PredecessorsLieBehindAndBranchesOfTheirJunctionBeside) {
  const auto listed = around("B", {-20, 20});
  EXPECT_THAT(
      listed,
      ElementsAre(Listed{"B", RoadSide::current, 0, true}, Listed{"A", RoadSide::behind, 1, true},
                  Listed{"E", RoadSide::behind, 1, true}, Listed{"C", RoadSide::beside, 2, false}));
  EXPECT_NEAR(offsets_m_["A"], -100, 0.05);
  EXPECT_NEAR(offsets_m_["C"], 0, 0.05);
}

TEST_F(Town, ASuccessorInAnotherMapIsFoundByTheVersionThatIsHeld) {
  const MapVersion next = {"next", "7"};
  add("F", 245, 300, {}, next);
  SegmentLayer d = *layer("D");
  d.successors.push_back({"F", "next"});
  HeldSegment held;
  held.layer = std::make_shared<const SegmentLayer>(std::move(d));
  held_.segments[{kTown, "D"}] = std::make_shared<const HeldSegment>(held);
  const auto key = key_of(layer("D")->successors.front(), *layer("D"), held_);
  ASSERT_TRUE(key.has_value());
  EXPECT_EQ(key->version, next);
  EXPECT_THAT(around("D", {90, 120}), ElementsAre(Listed{"D", RoadSide::current, 0, true},
                                                  Listed{"F", RoadSide::ahead, 1, true}));
  EXPECT_FALSE(key_of({"G", "nowhere"}, *layer("D"), held_).has_value());
}

}  // namespace
}  // namespace milepost
