// The client with the real server: both sides agree on the protocol.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "client/fetch/file_source.h"
#include "client/fetch/http_source.h"
#include "client/fetch/walls.h"
#include "schema/store/map_store.h"
#include "schema/tile/codec.h"
#include "server/catalog/catalog.h"
#include "server/server.h"
#include "tests/support/scripted_server.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;

Bytes tile_bytes(std::uint32_t index) {
  return Bytes(5000 + index, static_cast<std::uint8_t>(index));
}

// Two walls in one cell, one across the border to the next cell, and one in that.
const std::vector<Wall> kWalls = {{{49.001, 8.401}, {49.001, 8.402}, 0.25},
                                  {{49.001, 8.402}, {49.002, 8.402}, 0.25},
                                  {{49.003, 8.4049}, {49.003, 8.4051}, 0.5},
                                  {{49.004, 8.407}, {49.004, 8.408}, 0.25}};

// A map with lengths that are not exact decimal numbers, written as by a mapper. Tile 0 is longer
// by `more` bytes.
std::string write_map(const std::filesystem::path& file, std::size_t more = 0) {
  auto writer = MapWriter::create(file);
  EXPECT_TRUE(writer.ok());
  EXPECT_TRUE(writer->set_feature_json(to_json(FeatureParameters()).dump()).ok());
  EXPECT_TRUE(writer->add_layer("tracklets", R"({"items":"tracklets","focal_px":[400,900]})").ok());
  EXPECT_TRUE(writer->add_layer("walls", "{}").ok());
  const StoredSegment segment{"s1",
                              200.2,
                              {{49, 8.4, 110, 0}, {49.0018, 8.4, 111, 200.2}},
                              {{"s2"}, {"s2", "village"}},
                              {{"morning", 0, 200.2}},
                              {0.1, 80, false}};
  EXPECT_TRUE(writer->add_segment(segment).ok());
  for (std::uint32_t k = 0; k < 10; ++k) {
    const AlongRange along{20.0 * k + 1.0 / 3, 20.0 * k + 25 + 1.0 / 7};
    Bytes bytes = tile_bytes(k);
    if (k == 0) bytes.resize(bytes.size() + more, 1);
    EXPECT_TRUE(writer->add_tile("s1", "tracklets", k, along, 3, bytes).ok());
  }
  for (const WallTile& tile : tiles_of(kWalls)) {
    EXPECT_TRUE(writer->add_cell("walls", tile.cell, tile.walls.size(), encode_walls(tile)).ok());
  }
  auto build = writer->finish();
  EXPECT_TRUE(build.ok());
  return *build;
}

class ServedMapTest : public ::testing::Test {
 protected:
  ServedMapTest() {
    std::filesystem::create_directory(folder_ / "maps");
    version_ = {"town", write_map(folder_ / "maps" / "town.mpm")};
    auto catalog = server::Catalog::open(folder_ / "maps", server::CatalogSettings(),
                                         [](const std::string&) {});
    EXPECT_TRUE(catalog.ok());
    catalog_ = std::make_shared<server::CurrentCatalog>(*catalog);
    server::ServerSettings settings;
    settings.threads = 2;
    auto started = server::Server::start(catalog_, settings);
    EXPECT_TRUE(started.ok());
    server_ = std::move(started).value();
  }

  std::shared_ptr<MapSource> open_source(std::uint64_t cache_limit_bytes = 1U << 30U) const {
    HttpSourceSettings settings;
    settings.cache_limit_bytes = cache_limit_bytes;
    settings.server_url = "http://" + server_->address();
    settings.cache_directory = folder_ / "cache";
    settings.attempts = 1;
    auto source = open_http_source(settings);
    EXPECT_TRUE(source.ok());
    return std::move(source).value();
  }

  static std::vector<std::uint32_t> indices_of(const Result<std::vector<EncodedTile>>& tiles) {
    EXPECT_TRUE(tiles.ok()) << tiles.error().line();
    std::vector<std::uint32_t> indices;
    for (const EncodedTile& tile : *tiles) {
      EXPECT_EQ(tile.bytes, tile_bytes(tile.index));
      indices.push_back(tile.index);
    }
    return indices;
  }

  TempFolder folder_;
  MapVersion version_;
  std::shared_ptr<server::CurrentCatalog> catalog_;
  std::unique_ptr<server::Server> server_;
};

TEST_F(ServedMapTest, OfANewBuildOnlyWhatDiffersIsFetched) {
  const auto source = open_source();
  ASSERT_EQ(source->tiles(version_, "s1", "tracklets", {0, 200})->size(), 10U);
  const MapVersion next = {"town", write_map(folder_ / "maps" / "town.mpm", 1)};
  catalog_->replace(*catalog_->now()->reloaded(server::Catalog::Clock::now(),
                                               [](const std::string&) {}, {{}, true}));
  ASSERT_NE(next.build, version_.build);
  const SourceCounters before = source->counters();
  const auto tiles = source->tiles(next, "s1", "tracklets", {0, 200});
  ASSERT_TRUE(tiles.ok()) << tiles.error().line();
  EXPECT_EQ(tiles->size(), 10U);
  EXPECT_EQ(source->counters().tiles_fetched - before.tiles_fetched, 1U);
  EXPECT_EQ(source->counters().tiles_from_cache - before.tiles_from_cache, 9U);
}

TEST_F(ServedMapTest, TheServerAndTheFileAnswerTheSame) {
  const auto file = std::move(open_file_source(folder_ / "maps" / "town.mpm")).value();
  const auto served = open_source();
  const auto description = served->describe(version_);
  ASSERT_TRUE(description.ok()) << description.error().line();
  const auto& layer = description->layers.at("tracklets");
  ASSERT_TRUE(layer.ok()) << layer.error().line();
  EXPECT_EQ(layer->focal_px(), file->describe(version_)->layers.at("tracklets")->focal_px());
  EXPECT_EQ(*description->feature, *file->describe(version_)->feature);
  const auto segment = served->segment(version_, "s1");
  ASSERT_TRUE(segment.ok()) << segment.error().line();
  EXPECT_EQ(segment->vertices, file->segment(version_, "s1")->vertices);
  EXPECT_EQ(segment->length_m, 200.2);
  EXPECT_THAT(segment->successors,
              ElementsAre(Successor{"s2", "town"}, Successor{"s2", "village"}));
  EXPECT_EQ(segment->successors, file->segment(version_, "s1")->successors);
  EXPECT_EQ(segment->passes, file->segment(version_, "s1")->passes);
  EXPECT_EQ(segment->position_error, file->segment(version_, "s1")->position_error);
  EXPECT_EQ(*served->layer_bytes(version_, "s1", "tracklets"),
            *file->layer_bytes(version_, "s1", "tracklets"));
  EXPECT_TRUE(served->tiles(version_, "s1", "walls", {0, 100})->empty());

  const GeoPoint position{49.00045, 8.4001, 0};
  const auto near = served->segments_near(position, 50);
  const auto near_in_file = file->segments_near(position, 50);
  ASSERT_TRUE(near.ok()) << near.error().line();
  ASSERT_EQ(near->size(), 1U);
  EXPECT_EQ(near->front().version, version_);
  EXPECT_EQ(near->front().segment, "s1");
  EXPECT_NEAR(near->front().along_m, near_in_file->front().along_m, 0.01);
  EXPECT_NEAR(near->front().distance_m, near_in_file->front().distance_m, 0.01);
}

TEST_F(ServedMapTest, EveryPairOfTilesIsFetchedAlike) {
  const auto source = open_source(/*cache_limit_bytes=*/0);
  for (std::uint32_t first = 0; first < 9; ++first) {
    for (std::uint32_t last = first; last < 10; ++last) {
      const SourceCounters before = source->counters();
      const auto tiles =
          source->tiles(version_, "s1", "tracklets", {20.0 * first + 10, 20.0 * last + 10});
      std::vector<std::uint32_t> expected;
      for (std::uint32_t k = first; k <= last; ++k) expected.push_back(k);
      EXPECT_EQ(indices_of(tiles), expected);
      EXPECT_EQ(source->counters().tiles_fetched, before.tiles_fetched + expected.size());
    }
  }
  EXPECT_EQ(source->counters().requests, 2U + 54U);  // manifest, segment, 54 ranges
}

TEST_F(ServedMapTest, TheCacheServesWhenTheServerHasGone) {
  EXPECT_THAT(indices_of(open_source()->tiles(version_, "s1", "tracklets", {30, 70})),
              ElementsAre(1, 2, 3));
  const auto source = open_source();
  server_->stop();
  EXPECT_THAT(indices_of(source->tiles(version_, "s1", "tracklets", {30, 70})),
              ElementsAre(1, 2, 3));
  EXPECT_EQ(source->segments_near({49, 8.4, 0}, 50)->size(), 1U);
  EXPECT_EQ(source->tiles(version_, "s1", "tracklets", {100, 110}).error().code,
            ErrorCode::unavailable);
}

TEST_F(ServedMapTest, TheServerAndTheFileHaveTheSameWalls) {
  const auto file = std::move(open_file_source(folder_ / "maps" / "town.mpm")).value();
  const auto served = open_source();
  EXPECT_THAT(*served->maps(), ElementsAre(version_));
  const auto maps = maps_with_walls(*served);
  ASSERT_TRUE(maps.ok()) << maps.error().line();
  ASSERT_EQ(maps->size(), 1U);
  EXPECT_EQ(maps->front().version, version_);
  EXPECT_EQ(maps->front().bounds.east_deg, 8.41);
  EXPECT_EQ(maps->front().bounds.east_deg, maps_with_walls(*file)->front().bounds.east_deg);
  for (const Bounds& box : {Bounds{8.4, 49, 8.41, 49.005}, Bounds{8.401, 49, 8.402, 49.001},
                            Bounds{8.406, 49, 8.407, 49.001}, Bounds{8.405, 49, 8.405, 49},
                            Bounds{8.406, 49, -179, 49.001}, Bounds{1, 1, 2, 2}}) {
    const auto walls = walls_in(*served, version_, "walls", box);
    ASSERT_TRUE(walls.ok()) << walls.error().line();
    EXPECT_EQ(*walls, *walls_in(*file, version_, "walls", box)) << box.west_deg;
  }
  EXPECT_EQ(walls_in(*served, version_, "walls", {8.4, 49, 8.41, 49.005})->size(), kWalls.size());
  EXPECT_TRUE(walls_in(*served, version_, "tracklets", {8, 49, 9, 50})->empty());
}

TEST_F(ServedMapTest, TheCacheHasTheWallsWhenTheServerHasGone) {
  const Bounds box{8.4, 49, 8.41, 49.005};
  ASSERT_EQ(maps_with_walls(*open_source())->size(), 1U);
  ASSERT_TRUE(walls_in(*open_source(), version_, "walls", box).ok());
  server_->stop();
  const auto source = open_source();
  const auto maps = maps_with_walls(*source);
  ASSERT_TRUE(maps.ok()) << maps.error().line();
  ASSERT_EQ(maps->size(), 1U);
  EXPECT_EQ(walls_in(*source, maps->front().version, "walls", box)->size(), kWalls.size());
}

TEST_F(ServedMapTest, AnotherBuildIsGoneAndAnotherMapAbsent) {
  const auto source = open_source();
  const MapVersion old{"town", std::string(32, 'a')};
  EXPECT_EQ(source->segment(old, "s1").error().code, ErrorCode::gone);
  EXPECT_EQ(source->cells(old, "walls", {8, 49, 9, 50}).error().code, ErrorCode::gone);
  EXPECT_EQ(source->cells(version_, "roofs", {8, 49, 9, 50}).error().code, ErrorCode::not_found);
  EXPECT_EQ(source->segment(version_, "s7").error().code, ErrorCode::not_found);
  EXPECT_EQ(source->segment({"village", version_.build}, "s1").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace milepost::testing
