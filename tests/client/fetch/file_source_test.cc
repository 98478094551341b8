#include "client/fetch/file_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "schema/store/map_store.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Bytes tile_bytes(std::uint32_t index) {
  return Bytes(100 + index, static_cast<std::uint8_t>(index));
}

// The cell at 49 N 8.4 E; there is another to its east.
constexpr std::uint32_t kCell = 27800 * kCellColumns + 37680;

// The map "town" with two segments to the north, 200 m long, s2 about 73 m to the east of s1.
class FileSourceTest : public ::testing::Test {
 protected:
  FileSourceTest() {
    auto writer = MapWriter::create(file_);
    EXPECT_TRUE(writer.ok());
    EXPECT_TRUE(writer->set_feature_json(to_json(FeatureParameters()).dump()).ok());
    EXPECT_TRUE(
        writer->add_layer("tracklets", R"({"items":"tracklets","focal_px":[400,900]})").ok());
    add_segment(*writer, "s1", 8.400);
    add_segment(*writer, "s2", 8.401);
    for (std::uint32_t k = 0; k < 10; ++k) {
      const AlongRange along{20.0 * k, 20.0 * k + 25};
      EXPECT_TRUE(writer->add_tile("s1", "tracklets", k, along, 3, tile_bytes(k)).ok());
    }
    EXPECT_TRUE(writer->add_layer("walls", "{}").ok());
    for (std::uint32_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(writer->add_cell("walls", kCell + k, 3, tile_bytes(k)).ok());
    }
    auto build = writer->finish();
    EXPECT_TRUE(build.ok());
    version_ = {"town", *build};
    auto source = open_file_source(file_);
    EXPECT_TRUE(source.ok());
    source_ = std::move(source).value();
  }

  static void add_segment(MapWriter& writer, const std::string& id, double longitude_deg) {
    const StoredSegment segment{id,
                                200.2,
                                {{49, longitude_deg, 110, 0}, {49.0018, longitude_deg, 111, 200.2}},
                                {{"s9"}, {"s1", "village"}},
                                {{"morning", 5, 205.2}},
                                {0.2}};
    const Status added = writer.add_segment(segment);
    EXPECT_TRUE(added.ok()) << added.error().line();
  }

  TempFolder folder_;
  std::filesystem::path file_ = folder_ / "town.mpm";
  MapVersion version_;
  std::shared_ptr<MapSource> source_;
};

TEST_F(FileSourceTest, FindsTheSegmentsNearby) {
  const auto near = source_->segments_near({49.00045, 8.4001, 0}, 100);
  ASSERT_TRUE(near.ok());
  ASSERT_EQ(near->size(), 2U);
  EXPECT_EQ(near->front().version, version_);
  EXPECT_EQ(near->front().segment, "s1");
  EXPECT_NEAR(near->front().along_m, 50.04, 0.1);
  EXPECT_NEAR(near->front().distance_m, 7.3, 0.1);
  EXPECT_EQ(near->back().segment, "s2");
  EXPECT_EQ(source_->segments_near({49.00045, 8.4001, 0}, 10)->size(), 1U);
  EXPECT_EQ(source_->segments_near({10, 8.4001, 0}, 10)->size(), 0U);
  EXPECT_EQ(source_->segments_near({100, 8.4, 0}, 10).error().code, ErrorCode::invalid_input);
  // As a server does.
  EXPECT_EQ(source_->segments_near({49, 8.4, 0}, 0).error().code, ErrorCode::invalid_input);
  EXPECT_EQ(source_->segments_near({49, 8.4, 0}, 10001).error().code, ErrorCode::invalid_input);
  EXPECT_TRUE(source_->segments_near({49, 8.4, 0}, 10000).ok());
}

TEST_F(FileSourceTest, DescribesTheMapAndItsSegments) {
  const auto description = source_->describe(version_);
  ASSERT_TRUE(description.ok());
  EXPECT_EQ(description->version, version_);
  EXPECT_EQ(description->layers.at("tracklets")->focal_px(), 600);
  EXPECT_EQ(*description->feature, FeatureParameters());
  EXPECT_EQ(description->bounds.west_deg, 8.4);
  EXPECT_EQ(description->bounds.north_deg, 49.005);  // of the cells
  const auto segment = source_->segment(version_, "s2");
  ASSERT_TRUE(segment.ok());
  EXPECT_EQ(segment->id, "s2");
  EXPECT_EQ(segment->vertices.back(), (GeoPoint{49.0018, 8.401, 111}));
  EXPECT_THAT(segment->successors,
              ElementsAre(Successor{"s9", "town"}, Successor{"s1", "village"}));
  EXPECT_THAT(segment->passes, ElementsAre(StoredPass{"morning", 5, 205.2}));
  EXPECT_EQ(segment->position_error, PositionError{0.2});
}

TEST_F(FileSourceTest, ReadsTheTilesOfARange) {
  const auto tiles = source_->tiles(version_, "s1", "tracklets", {30, 60});
  ASSERT_TRUE(tiles.ok());
  std::vector<std::uint32_t> indices;
  for (const EncodedTile& tile : *tiles) {
    indices.push_back(tile.index);
    EXPECT_EQ(tile.bytes, tile_bytes(tile.index));
  }
  EXPECT_THAT(indices, ElementsAre(1, 2, 3));
  EXPECT_EQ(*source_->layer_bytes(version_, "s1", "tracklets"), 10U * 100 + 45);
  EXPECT_EQ(source_->counters().requests, 0U);
}

TEST_F(FileSourceTest, ReadsTheCellsOfABox) {
  const auto both = source_->cells(version_, "walls", {8.4, 49, 8.41, 49.005});
  ASSERT_TRUE(both.ok()) << both.error().line();
  ASSERT_EQ(both->size(), 2U);
  for (std::uint32_t k = 0; k < 2; ++k) {
    EXPECT_EQ((*both)[k].cell, kCell + k);
    EXPECT_EQ((*both)[k].bytes, tile_bytes(k));
  }
  EXPECT_EQ(source_->cells(version_, "walls", {8.406, 49, 8.41, 49.001})->size(), 1U);
  EXPECT_EQ(source_->cells(version_, "walls", {8.406, 49, -170, 49.001})->size(), 1U);
  EXPECT_TRUE(source_->cells(version_, "walls", {9, 49, 10, 50})->empty());
  EXPECT_TRUE(source_->cells(version_, "tracklets", {8, 49, 10, 50})->empty());
}

TEST_F(FileSourceTest, RefusesABoxThatIsNone) {
  const auto cells = source_->cells(version_, "walls", {8, 50, 9, 49});
  ASSERT_FALSE(cells.ok());
  EXPECT_EQ(cells.error().code, ErrorCode::invalid_input);
}

TEST_F(FileSourceTest, IsACatalogOfOneMap) { EXPECT_THAT(*source_->maps(), ElementsAre(version_)); }

TEST_F(FileSourceTest, TellsTheAbsentFromTheGone) {
  const Bounds box{8, 49, 9, 50};
  EXPECT_EQ(source_->cells(version_, "roofs", box).error().code, ErrorCode::not_found);
  EXPECT_EQ(source_->cells({"town", std::string(32, 'a')}, "walls", box).error().code,
            ErrorCode::gone);
  EXPECT_EQ(source_->segment(version_, "s7").error().code, ErrorCode::not_found);
  EXPECT_EQ(source_->tiles(version_, "s1", "clouds", {0, 10}).error().code, ErrorCode::not_found);
  EXPECT_EQ(source_->describe({"village", version_.build}).error().code, ErrorCode::not_found);
  const auto old = source_->describe({"town", std::string(32, 'a')});
  ASSERT_FALSE(old.ok());
  EXPECT_EQ(old.error().code, ErrorCode::gone);
  EXPECT_THAT(old.error().line(), HasSubstr("town.mpm"));
  EXPECT_EQ(open_file_source(folder_ / "absent.mpm").error().code, ErrorCode::not_found);
}

TEST_F(FileSourceTest, SeveralThreadsShareASource) {
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([this] {
      for (std::uint32_t k = 0; k < 10; ++k) {
        const auto tiles =
            source_->tiles(version_, "s1", "tracklets", {20.0 * k + 10, 20.0 * k + 10});
        ASSERT_TRUE(tiles.ok());
        EXPECT_EQ(tiles->front().bytes, tile_bytes(k));
        EXPECT_TRUE(source_->segments_near({49, 8.4, 0}, 50).ok());
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST_F(FileSourceTest, StopsBetweenTilesOnceItIsTold) {
  int asked = 0;
  const auto hurried =
      source_->until([&] { return ++asked > 3; }, MapSource::Asking::as_often_as_set);
  const auto tiles = hurried->tiles(version_, "s1", "tracklets", {0, 200});
  ASSERT_FALSE(tiles.ok());
  EXPECT_EQ(tiles.error().code, ErrorCode::cancelled);
  EXPECT_EQ(asked, 4);
  EXPECT_EQ(hurried->cells(version_, "walls", {-180, -90, 180, 90}).error().code,
            ErrorCode::cancelled);
  EXPECT_TRUE(source_->tiles(version_, "s1", "tracklets", {0, 200}).ok());
}

}  // namespace
}  // namespace milepost::testing
