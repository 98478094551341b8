#include "client/fetch/provider_state.h"

#include <gtest/gtest.h>

#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const MapVersion kStateTown = {"town", "build"};
const SegmentKey kStateRoad = {kStateTown, "road"};
constexpr double kTileM = 20;
constexpr double kLengthM = 400;

GeoPoint at(double north_m) { return LocalFrame({49, 8.4, 0}).geo_from_enu({0, north_m, 0}); }

// 400 m in tiles of 20 m.
std::shared_ptr<const SegmentLayer> road(const SegmentKey& key = kStateRoad) {
  std::vector<testing::IndexedTile> tiles;
  for (double from_m = 0; from_m < kLengthM; from_m += kTileM) {
    tiles.push_back({{from_m + 1, from_m + kTileM - 1}, std::nullopt});
  }
  return testing::layer_of(key, *RouteLine::from_vertices({at(0), at(kLengthM)}), {}, tiles);
}

std::shared_ptr<const DecodedTile> a_tile() {
  return std::make_shared<const DecodedTile>(LandmarkTile{});
}

class StateOfAProvider : public ::testing::Test {
 protected:
  static ProviderSettings settings() {
    ProviderSettings settings;
    settings.backoff = {.first_s = 1, .longest_s = 10, .jitter = 0};
    settings.kept_m = 40;
    return settings;
  }

  // Sets the wanted ranges of the road.
  void want(std::vector<std::pair<AlongRange, int>> ranges) {
    Wants wants;
    wants.around = around_;
    for (const auto& [range, priority] : ranges)
      wants.tiles.push_back({kStateRoad, range, priority});
    state_.want(std::move(wants));
  }

  // Provides the road's documents.
  void open() {
    want({{{0, 1}, 0}});
    state_.take(road());
  }

  // Reports that no wanted tile is in the cache.
  void find_nothing_stored() {
    while (const auto stored = state_.next_stored()) {
      state_.is_not_stored(stored->of->key, stored->entry.index);
    }
  }

  // The indices of the tiles to be fetched next; none if the next task is another.
  std::vector<std::uint32_t> next_run() const {
    std::vector<std::uint32_t> run;
    const auto task = state_.next_fetch(now_);
    if (!task || !std::holds_alternative<FetchTiles>(*task)) return run;
    for (const TileEntry& entry : std::get<FetchTiles>(*task).tiles) run.push_back(entry.index);
    return run;
  }

  void fail_next(SteadyTime::duration after = milliseconds(10),
                 ErrorCode code = ErrorCode::unavailable) {
    const auto task = state_.next_fetch(now_);
    ASSERT_TRUE(task);
    const SteadyTime began = now_;
    now_ += after;
    state_.failed(*task, {Error{code, "server", "fails", ""}, 0, began, now_});
  }

  std::optional<Surroundings> around_;
  ProviderState state_{settings()};
  SteadyTime now_{seconds(1000)};
};

using Indices = std::vector<std::uint32_t>;

TEST_F(StateOfAProvider, AsksAroundThenForDocumentsThenForTiles) {
  around_ = Surroundings{at(100), 50};
  want({});
  auto task = state_.next_fetch(now_);
  ASSERT_TRUE(task && std::holds_alternative<AskAround>(*task));
  EXPECT_EQ(std::get<AskAround>(*task).asked.radius_m, 50 + settings().surroundings_margin_m);
  EXPECT_FALSE(state_.is_settled());
  state_.take(std::get<AskAround>(*task), {{kStateTown, "road", 100, 3, kLengthM}}, now_);
  task = state_.next_fetch(now_);
  ASSERT_TRUE(task && std::holds_alternative<ReadDocuments>(*task));
  EXPECT_EQ(std::get<ReadDocuments>(*task).key, kStateRoad);
  EXPECT_FALSE(state_.is_settled());
  state_.take(road());
  EXPECT_TRUE(state_.is_settled());  // no tile is wanted
  want({{{90, 130}, 0}});
  EXPECT_FALSE(state_.is_settled());
  find_nothing_stored();
  EXPECT_EQ(next_run(), (Indices{4, 5, 6}));
}

TEST_F(StateOfAProvider, KnowsTheSurroundingsAsFarAsItAsked) {
  around_ = Surroundings{at(100), 50};
  want({});
  state_.take(std::get<AskAround>(*state_.next_fetch(now_)), {}, now_);
  around_ = Surroundings{at(199), 50};
  want({});
  EXPECT_FALSE(state_.next_fetch(now_));
  around_ = Surroundings{at(202), 50};
  want({});
  ASSERT_TRUE(state_.next_fetch(now_));
  EXPECT_FALSE(state_.is_settled());
}

TEST_F(StateOfAProvider, LooksUpTheBuildsOfNeighbouringMaps) {
  Wants wants;
  wants.maps = {"east"};
  state_.want(wants);
  EXPECT_FALSE(state_.is_settled());
  const auto is_catalog_next = [&] {
    const auto task = state_.next_fetch(now_);
    return task && std::holds_alternative<AskCatalog>(*task);
  };
  ASSERT_TRUE(is_catalog_next());
  fail_next();
  EXPECT_TRUE(state_.is_settled());
  EXPECT_FALSE(is_catalog_next());  // not at once
  now_ = *state_.next_due(now_);
  ASSERT_TRUE(is_catalog_next());
  state_.take(AskCatalog(), {kStateTown}, now_);
  EXPECT_FALSE(is_catalog_next());  // it is not in the catalog, perhaps later
  now_ = *state_.next_due(now_);
  ASSERT_TRUE(is_catalog_next());
  const MapVersion east = {"east", "7"};
  state_.take(AskCatalog(), {kStateTown, east}, now_);
  EXPECT_FALSE(state_.next_fetch(now_).has_value());
  ASSERT_EQ(state_.held()->current_maps.size(), 1U);
  EXPECT_EQ(state_.held()->current_maps.at("east"), east);

  // A build that is gone is looked up anew.
  const SegmentKey beyond = {east, "beyond"};
  wants.tiles = {{beyond, {0, 10}, 0}};
  state_.want(wants);
  fail_next(milliseconds(10), ErrorCode::gone);
  EXPECT_TRUE(state_.held()->current_maps.empty());
  EXPECT_TRUE(is_catalog_next());
}

TEST_F(StateOfAProvider, WhatIsStoredIsReadAndNotFetched) {
  open();
  want({{{50, 70}, 0}});
  const auto stored = state_.next_stored();
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->entry.index, 2U);
  EXPECT_EQ(next_run(), Indices{});
  state_.take(kStateRoad, 2, a_tile());
  EXPECT_EQ(state_.next_stored()->entry.index, 3U);
  EXPECT_TRUE(state_.held()->find(kStateRoad)->tiles.contains(2));
}

TEST_F(StateOfAProvider, TheFirstPriorityComesFirst) {
  open();
  want({{{50, 170}, 2}, {{200, 215}, 1}});
  EXPECT_EQ(state_.next_stored()->entry.index, 10U);
  find_nothing_stored();
  EXPECT_EQ(next_run(), Indices{10});
  state_.take(kStateRoad, 10, a_tile());
  EXPECT_EQ(next_run().front(), 2U);
}

TEST_F(StateOfAProvider, DiscardsWhatIsFarFromWhatIsWanted) {
  open();
  want({{{50, 110}, 0}});
  for (std::uint32_t i = 2; i <= 5; ++i) state_.take(kStateRoad, i, a_tile());
  want({{{120, 130}, 0}});  // tiles from 80 m on are kept
  const auto& tiles = state_.held()->find(kStateRoad)->tiles;
  EXPECT_FALSE(tiles.contains(3));
  EXPECT_TRUE(tiles.contains(4));
  state_.want({});
  EXPECT_EQ(state_.held()->find(kStateRoad), nullptr);
}

TEST_F(StateOfAProvider, ATileThatCameTooLateIsNotKept) {
  open();
  want({{{50, 55}, 0}});
  want({{{350, 355}, 0}});
  state_.take(kStateRoad, 2, a_tile());
  EXPECT_TRUE(state_.held()->find(kStateRoad)->tiles.empty());
}

TEST_F(StateOfAProvider, ARefusedTileStopsNoOther) {
  open();
  want({{{0, 159}, 0}});
  find_nothing_stored();
  // Requests of tile 5 fail, others succeed.
  for (int request = 0; request < 30; ++request) {
    const Indices run = next_run();
    if (run.empty()) {
      now_ = std::max(now_, state_.next_due(now_).value_or(now_));
      continue;
    }
    const FetchTask task = *state_.next_fetch(now_);
    if (std::ranges::find(run, 5U) != run.end()) {
      fail_next();
      continue;
    }
    for (const std::uint32_t index : run) state_.take(kStateRoad, index, a_tile());
    state_.succeeded(task);
  }
  const HeldSegment& held = *state_.held()->find(kStateRoad);
  EXPECT_EQ(held.tiles.size(), 7U);
  ASSERT_TRUE(held.missing.contains(5));
  EXPECT_EQ(held.missing.size(), 1U);
  EXPECT_TRUE(state_.is_settled());
  // It is requested again with growing pauses, and other wanted tiles at once.
  now_ += seconds(20);
  EXPECT_EQ(next_run(), Indices{5});
  fail_next();
  want({{{0, 175}, 0}});
  find_nothing_stored();
  EXPECT_EQ(next_run(), Indices{8});
}

TEST_F(StateOfAProvider, ATileThatComesAtLastIsMissingNoMore) {
  open();
  want({{{50, 55}, 0}});
  find_nothing_stored();
  fail_next();
  EXPECT_TRUE(state_.held()->find(kStateRoad)->missing.contains(2));
  EXPECT_EQ(next_run(), Indices{});
  now_ += seconds(2);
  EXPECT_EQ(next_run(), Indices{2});
  state_.take(kStateRoad, 2, a_tile());
  EXPECT_FALSE(state_.held()->find(kStateRoad)->missing.contains(2));
}

TEST_F(StateOfAProvider, ANetworkThatIsAwayIsNotWaitedFor) {
  open();
  want({{{0, 159}, 0}});
  find_nothing_stored();
  fail_next(seconds(10));  // a request that stalls
  EXPECT_TRUE(state_.is_settled());
  want({{{100, 259}, 0}});  // tiles that were never requested
  find_nothing_stored();
  EXPECT_TRUE(state_.is_settled());
  EXPECT_EQ(next_run(), Indices{});
  now_ += seconds(2);
  const FetchTask task = *state_.next_fetch(now_);
  for (const TileEntry& entry : std::get<FetchTiles>(task).tiles) {
    state_.take(kStateRoad, entry.index, a_tile());
  }
  state_.succeeded(task);
  EXPECT_FALSE(state_.is_settled());  // the network is back, and the rest is awaited
}

TEST_F(StateOfAProvider, DocumentsThatFailAreAskedForAgain) {
  want({{{0, 10}, 0}});
  fail_next(milliseconds(10), ErrorCode::corrupt);
  EXPECT_TRUE(state_.is_settled());
  ASSERT_TRUE(state_.held()->find(kStateRoad)->failure);
  EXPECT_FALSE(state_.next_fetch(now_));
  now_ = *state_.next_due(now_);
  ASSERT_TRUE(state_.next_fetch(now_));
  state_.take(road());
  EXPECT_FALSE(state_.held()->find(kStateRoad)->failure);
}

TEST_F(StateOfAProvider, ABuildThatIsGoneIsGivenUpAndLookedUpAnew) {
  around_ = Surroundings{at(100), 50};
  want({});
  state_.take(std::get<AskAround>(*state_.next_fetch(now_)),
              {{kStateTown, "road", 100, 3, kLengthM}}, now_);
  state_.take(road());
  want({{{90, 95}, 0}});
  find_nothing_stored();
  fail_next(milliseconds(10), ErrorCode::gone);
  ASSERT_TRUE(state_.held()->find(kStateRoad)->failure);
  EXPECT_EQ(state_.held()->find(kStateRoad)->failure->code, ErrorCode::gone);
  EXPECT_FALSE(state_.held()->segments_near({at(100), 50}));
  const auto task = state_.next_fetch(now_);
  ASSERT_TRUE(task && std::holds_alternative<AskAround>(*task));
  const MapVersion next = {"town", "next"};
  state_.take(std::get<AskAround>(*task), {{next, "road", 100, 3, kLengthM}}, now_);
  const auto documents = state_.next_fetch(now_);
  ASSERT_TRUE(documents && std::holds_alternative<ReadDocuments>(*documents));
  EXPECT_EQ(std::get<ReadDocuments>(*documents).key.version, next);
}

TEST_F(StateOfAProvider, WhatIsUnusableIsMissingAndSettled) {
  open();
  want({{{50, 55}, 0}});
  state_.is_unusable(kStateRoad, 2, Error{ErrorCode::corrupt, "tile 2", "is damaged", ""}, now_);
  EXPECT_EQ(state_.held()->find(kStateRoad)->missing.at(2).code, ErrorCode::corrupt);
  EXPECT_TRUE(state_.is_settled());
  EXPECT_FALSE(state_.next_stored());
}

TEST_F(StateOfAProvider, WhatIsHeldIsTheSameObjectUntilItChanges) {
  open();
  const auto before = state_.held();
  want({{{0, 5}, 0}});
  EXPECT_EQ(state_.held(), before);
  state_.take(kStateRoad, 0, a_tile());
  EXPECT_NE(state_.held(), before);
}

// A server that is out of date lists the build that is gone: it is asked again later.
TEST_F(StateOfAProvider, ABuildThatIsGoneIsNotTakenUpAgain) {
  around_ = Surroundings{at(100), 50};
  want({});
  const auto ask = [&] {
    const auto task = state_.next_fetch(now_);
    ASSERT_TRUE(task && std::holds_alternative<AskAround>(*task));
    state_.take(std::get<AskAround>(*task), {{kStateTown, "road", 100, 3, kLengthM}}, now_);
  };
  ask();
  state_.take(road());
  want({{{90, 95}, 0}});
  find_nothing_stored();
  fail_next(milliseconds(10), ErrorCode::gone);
  ask();
  want({{{90, 95}, 0}});
  EXPECT_FALSE(state_.next_fetch(now_));  // not at once
  EXPECT_TRUE(state_.is_settled());
  EXPECT_EQ(state_.held()->find(kStateRoad)->failure->code, ErrorCode::gone);
  now_ = *state_.next_due(now_);
  ask();
}

// If there are more segments than lines to read, those that may be the nearest now.
TEST_F(StateOfAProvider, ReadsTheLinesOfTheNearestSegments) {
  ProviderSettings few = settings();
  few.max_segments = 2;
  few.surroundings_margin_m = 1000;
  state_ = ProviderState(few);
  around_ = Surroundings{at(0), 100};
  want({});
  std::vector<NearbySegment> told;
  for (const double distance_m : {10.0, 50.0, 90.0, 600.0, 620.0, 900.0}) {
    told.push_back({kStateTown, "s" + std::to_string(told.size()), 0, distance_m, kLengthM});
  }
  state_.take(std::get<AskAround>(*state_.next_fetch(now_)), told, now_);
  const auto next_document = [&]() -> std::string {
    const auto task = state_.next_fetch(now_);
    const auto* documents = task ? std::get_if<ReadDocuments>(&*task) : nullptr;
    return documents ? documents->key.segment : "none";
  };
  EXPECT_EQ(next_document(), "s0");
  state_.take(road({kStateTown, "s0"}));
  EXPECT_EQ(next_document(), "s1");
  state_.take(road({kStateTown, "s1"}));
  EXPECT_EQ(next_document(), "none");
  around_ = Surroundings{at(615), 100};  // still within the known surroundings
  want({});
  EXPECT_FALSE(state_.is_settled());
  EXPECT_EQ(next_document(), "s4");
}

TEST_F(StateOfAProvider, WhatIsWantedComesBeforeTheLinesOfNeighbours) {
  around_ = Surroundings{at(100), 50};
  want({});
  state_.take(std::get<AskAround>(*state_.next_fetch(now_)),
              {{kStateTown, "a", 100, 3, kLengthM}, {kStateTown, "road", 100, 5, kLengthM}}, now_);
  want({{{90, 95}, 0}});
  EXPECT_EQ(std::get<ReadDocuments>(*state_.next_fetch(now_)).key, kStateRoad);
  state_.take(road());
  find_nothing_stored();
  EXPECT_EQ(next_run(), Indices{4});
  state_.take(kStateRoad, 4, a_tile());
  EXPECT_EQ(std::get<ReadDocuments>(*state_.next_fetch(now_)).key.segment, "a");
}

// Old failures do not show that the network is unavailable now.
TEST_F(StateOfAProvider, ANetworkThatWasNotAskedSinceIsNotAway) {
  open();
  want({{{0, 39}, 0}});
  find_nothing_stored();
  fail_next();  // of two tiles, at once
  now_ += seconds(60);
  want({{{200, 239}, 0}});
  find_nothing_stored();
  EXPECT_FALSE(state_.is_settled());
}

TEST_F(StateOfAProvider, ATileThatCannotBeUsedIsNotFetchedAgain) {
  open();
  want({{{50, 55}, 0}});
  find_nothing_stored();
  state_.is_unusable(kStateRoad, 2, Error{ErrorCode::corrupt, "tile 2", "no tile", ""}, now_);
  now_ += seconds(3600);
  EXPECT_EQ(next_run(), Indices{});
  // A failed tile is also remembered while it is not wanted for a moment.
  want({{{90, 95}, 0}});
  find_nothing_stored();
  fail_next();
  want({{{110, 115}, 0}});
  want({{{90, 95}, 0}});
  EXPECT_EQ(next_run(), Indices{});
}

TEST_F(StateOfAProvider, NothingIsFetchedWhileSomeMayBeStored) {
  open();
  want({{{50, 90}, 0}});
  state_.is_not_stored(kStateRoad, 2);
  EXPECT_EQ(next_run(), Indices{});
  find_nothing_stored();
  EXPECT_EQ(next_run(), (Indices{2, 3, 4}));
}

}  // namespace
}  // namespace milepost
