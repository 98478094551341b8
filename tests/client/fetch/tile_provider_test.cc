#include "client/fetch/tile_provider.h"

#include <gtest/gtest.h>

#include <thread>

#include "schema/tile/codec.h"
#include "tests/client/fetch/memory_source.h"

namespace milepost {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

const MapVersion kTown = {"town", "build"};
const SegmentKey kRoad = {kTown, "road"};
constexpr std::uint32_t kTiles = 10;  // of 20 m

GeoPoint place_at(double north_m) { return LocalFrame({49, 8.4, 0}).geo_from_enu({0, north_m, 0}); }

std::shared_ptr<testing::MemorySource> a_map() {
  auto map = std::make_shared<testing::MemorySource>(
      kTown, "wisurf", nlohmann::json{{"items", "frames"}, {"focal_px", {400, 400}}});
  std::vector<testing::MemorySource::Tile> tiles;
  for (std::uint32_t i = 0; i < kTiles; ++i) {
    const ImageDescriptorTile tile{"road", i, {{20.0 * i + 5, {}, ImageDescriptor{}}}};
    tiles.push_back({{20.0 * i + 1, 20.0 * i + 19}, encode_frames(tile)});
  }
  map->add({"road", 200, {place_at(0), place_at(200)}, {}}, std::move(tiles));
  return map;
}

ProviderSettings soon_again() {
  ProviderSettings settings;
  settings.backoff.first_s = 0.01;
  return settings;
}

Wants wants_of(const AlongRange& range) {
  Wants wants;
  wants.around = Surroundings{place_at(50), 30};
  wants.tiles = {{kRoad, range}};
  return wants;
}

void settle(const TileProvider& provider) {
  const SteadyTime deadline = steady_clock::now() + seconds(20);
  while (!provider.is_settled() && steady_clock::now() < deadline) {
    provider.wait_for_change(provider.held(), deadline);
  }
  EXPECT_TRUE(provider.is_settled());
}

std::size_t tiles_held(const TileProvider& provider) {
  const auto held = provider.held();
  const HeldSegment* road = held->find(kRoad);
  return road == nullptr ? 0 : road->tiles.size();
}

TEST(TileProvider, BringsWhatIsWanted) {
  const auto map = a_map();
  TileProvider provider(map, "wisurf", soon_again());
  EXPECT_TRUE(provider.is_settled());
  provider.want(wants_of({30, 90}));
  settle(provider);
  const auto held = provider.held();
  ASSERT_NE(held->find(kRoad), nullptr);
  EXPECT_EQ(held->find(kRoad)->tiles.size(), 4U);
  EXPECT_EQ(std::get<ImageDescriptorTile>(*held->find(kRoad)->tiles.at(2)).frames.front().along_m,
            45);
  EXPECT_EQ(held->segments_near({place_at(60), 30})->front().segment, "road");
}

TEST(TileProvider, BringsTheBuildsOfNeighbouringMaps) {
  TileProvider provider(a_map(), "wisurf", soon_again());
  Wants wants;
  wants.maps = {"town"};
  provider.want(wants);
  settle(provider);
  ASSERT_EQ(provider.held()->current_maps.size(), 1U);
  EXPECT_EQ(provider.held()->current_maps.at("town"), kTown);
}

TEST(TileProvider, EachDocumentIsReadOnceAndTilesInOneRequest) {
  const auto map = a_map();
  TileProvider provider(map, "wisurf", soon_again());
  provider.want(wants_of({0, 100}));
  settle(provider);
  provider.want(wants_of({50, 150}));
  settle(provider);
  EXPECT_EQ(map->near_requests(), 1);
  EXPECT_EQ(map->document_requests(), 2);  // the map's and the segment's
  EXPECT_EQ(map->tile_requests(), 2);
}

TEST(TileProvider, TheCallersThreadNeverEntersTheSource) {
  const auto map = a_map();
  TileProvider provider(map, "wisurf", soon_again());
  provider.want(wants_of({0, 100}));
  settle(provider);
  EXPECT_FALSE(map->callers().contains(std::this_thread::get_id()));
  EXPECT_GE(map->callers().size(), 1U);
}

TEST(TileProvider, NoCallWaitsForASourceThatHangs) {
  const auto map = a_map();
  map->block();
  TileProvider provider(map, "wisurf", soon_again());
  const SteadyTime began = steady_clock::now();
  for (int i = 0; i < 1000; ++i) {
    provider.want(wants_of({0.1 * i, 100 + 0.1 * i}));
    EXPECT_TRUE(provider.held()->segments.size() <= 1);
    EXPECT_FALSE(provider.is_settled());
  }
  // A thousand calls while the source hangs: a lock held during I/O would block forever.
  EXPECT_LT(steady_clock::now() - began, seconds(10));
  map->block(false);
  settle(provider);
  EXPECT_GT(tiles_held(provider), 0U);
}

TEST(TileProvider, WhatIsStoredComesWhileTheNetworkHangs) {
  const auto map = a_map();
  TileProvider provider(map, "wisurf", soon_again());
  provider.want(wants_of({0, 10}));
  settle(provider);
  map->block();
  provider.want(wants_of({0, 50}));  // is requested, and hangs
  while (map->tile_requests() < 2) std::this_thread::sleep_for(milliseconds(1));
  map->store_tiles();
  provider.want(wants_of({100, 190}));
  const SteadyTime deadline = steady_clock::now() + seconds(20);
  while (tiles_held(provider) < 6 && steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_GE(tiles_held(provider), 6U);
}

TEST(TileProvider, EndsWhileTheSourceHangs) {
  const auto map = a_map();
  map->block();
  const SteadyTime began = steady_clock::now();
  {
    TileProvider provider(map, "wisurf", soon_again());
    provider.want(wants_of({0, 100}));
    while (map->near_requests() == 0) std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_LT(steady_clock::now() - began, seconds(5));
}

TEST(TileProvider, AWaitEndsAtItsDeadline) {
  const auto map = a_map();
  map->block();
  TileProvider provider(map, "wisurf", soon_again());
  provider.want(wants_of({0, 100}));
  provider.wait_for_change(provider.held(), steady_clock::now() + milliseconds(20));
  EXPECT_FALSE(provider.is_settled());
}

TEST(TileProvider, UsesWhatIsHeldWhereOneTileIsRefused) {
  const auto map = a_map();
  map->refuse_tile(4);
  TileProvider provider(map, "wisurf", soon_again());
  provider.want(wants_of({0, 199}));
  const SteadyTime deadline = steady_clock::now() + seconds(20);
  while (tiles_held(provider) < kTiles - 1 && steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(tiles_held(provider), kTiles - 1);
  const auto held = provider.held();
  EXPECT_TRUE(held->find(kRoad)->missing.contains(4));
}

TEST(TileProvider, ASourceThatComesBackIsUsedAgain) {
  const auto map = a_map();
  map->be_unavailable();
  TileProvider provider(map, "wisurf", soon_again());
  provider.want(wants_of({0, 10}));
  settle(provider);
  EXPECT_EQ(tiles_held(provider), 0U);
  map->be_unavailable(false);
  const SteadyTime deadline = steady_clock::now() + seconds(20);
  while (tiles_held(provider) == 0 && steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(tiles_held(provider), 1U);
}

}  // namespace
}  // namespace milepost
