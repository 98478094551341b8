// The catalog and the cells over HTTP, from a server that can misbehave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <thread>
#include <vector>

#include "tests/client/fetch/misbehaving_server.h"

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Within the cells of two rows and columns: 0, 1, 3 and 4 of the fake map.
constexpr Bounds kSouthWest{8.401, 49.001, 8.408, 49.008};
constexpr Bounds kEverything{8, 48, 9, 50};
// The length of cells 0, 1 and 3.
constexpr std::size_t kThreeCells = 500 + 510 + 530;

class HttpAreasTest : public MisbehavingServerTest {
 protected:
  std::vector<std::string> cell_requests() const { return requests(is_cell_target); }

  // `expected`: numbers of the fake map's cells.
  void expect_cells(MapSource& source, const Bounds& box,
                    const std::vector<std::uint32_t>& expected) const {
    const auto cells = source.cells(map_.version(), "walls", box);
    ASSERT_TRUE(cells.ok()) << cells.error().line();
    ASSERT_EQ(cells->size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ((*cells)[i].cell, map_.cells[expected[i]].cell);
      EXPECT_EQ((*cells)[i].bytes, map_.encoded_cell(expected[i])) << expected[i];
    }
  }

  Error cells_error(MapSource& source, const Bounds& box) const {
    const auto cells = source.cells(map_.version(), "walls", box);
    if (cells.ok()) ADD_FAILURE() << "the cells came";
    return cells.ok() ? Error{} : cells.error();
  }
};

TEST_F(HttpAreasTest, AColdFetchBringsABoxInOneRequest) {
  const auto source = open_source();
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  // From the middle of cell 0 to the middle of cell 4.
  EXPECT_THAT(cell_requests(), ElementsAre(HasSubstr("/areas/walls?bbox=8.4025")));
  EXPECT_EQ(server_.requests().size(), 3U);  // with the manifest and the index
  const SourceCounters counters = source->counters();
  EXPECT_EQ(counters.tiles_fetched, 4U);
  EXPECT_EQ(counters.tiles_from_cache, 0U);
  EXPECT_EQ(counters.bytes_received,
            map_.manifest().size() + map_.areas_document().size() + kThreeCells + 540);
}

TEST_F(HttpAreasTest, AWarmCacheNeedsNoRequest) {
  expect_cells(*open_source(), kSouthWest, {0, 1, 3, 4});
  const std::size_t before = server_.requests().size();
  const auto source = open_source();
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  EXPECT_EQ(server_.requests().size(), before);
  EXPECT_EQ(source->counters().tiles_from_cache, 4U);
}

TEST_F(HttpAreasTest, OnlyTheCellsAheadAreFetched) {
  const auto source = open_source();
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  expect_cells(*source, {8.406, 49.006, 8.413, 49.013}, {4, 5, 7, 8});
  ASSERT_EQ(cell_requests().size(), 3U);
  EXPECT_THAT(cell_requests()[1], HasSubstr("?bbox=8.4125,49.0075,8.4125,49.0125"));  // 5 and 8
  EXPECT_THAT(cell_requests()[2], HasSubstr("/areas/walls/" + std::to_string(map_.cells[7].cell)));
  EXPECT_EQ(source->counters().tiles_fetched, 7U);
  EXPECT_EQ(source->counters().tiles_from_cache, 1U);
}

TEST_F(HttpAreasTest, ABoxBesideAllCellsIsAnEmptyAnswer) {
  const auto source = open_source();
  expect_cells(*source, {10, 49, 11, 50}, {});
  EXPECT_THAT(cell_requests(), IsEmpty());
}

TEST_F(HttpAreasTest, ABoxThatGoesAcrossLongitude180IsAnswered) {
  expect_cells(*open_source(), {8.4105, 49, -170, 49.001}, {2});
}

TEST_F(HttpAreasTest, AWrongBoxIsRefusedBeforeTheServerIsAsked) {
  const auto source = open_source();
  for (const Bounds& box : {Bounds{8, 50, 9, 49}, Bounds{8, 49, 181, 50}}) {
    EXPECT_EQ(cells_error(*source, box).code, ErrorCode::invalid_input);
  }
  EXPECT_THAT(server_.requests(), IsEmpty());
}

TEST_F(HttpAreasTest, AfterABreakOffOnlyTheRestIsAskedFor) {
  answer_next("bbox", {{.body = map_.box_body(kSouthWest), .break_off_after = kThreeCells + 7}});
  const auto source = open_source();
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  ASSERT_EQ(cell_requests().size(), 2U);
  EXPECT_THAT(cell_requests()[1], HasSubstr("/areas/walls/" + std::to_string(map_.cells[4].cell)));
  EXPECT_THAT(pauses_s_, IsEmpty());
}

TEST_F(HttpAreasTest, WhatABreakOffLeftIsKeptForTheNextRun) {
  const ScriptedAnswer busy = {.status = 503};
  answer_next(
      "/areas/",
      {{.body = map_.box_body(kSouthWest), .break_off_after = kThreeCells}, busy, busy, busy});
  EXPECT_EQ(cells_error(*open_source(), kSouthWest).code, ErrorCode::unavailable);
  EXPECT_THAT(pauses_s_, ElementsAre(0.25, 0.5));
  const auto source = open_source();
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  EXPECT_EQ(source->counters().tiles_from_cache, 3U);
}

TEST_F(HttpAreasTest, AWrongByteIsRefusedAndNotStored) {
  spoil_answers(is_cell_target, [](std::string& body) { body[kThreeCells + 5] ^= 1; });
  const auto source = open_source();
  const Error error = cells_error(*source, kSouthWest);
  EXPECT_EQ(error.code, ErrorCode::corrupt);
  EXPECT_THAT(error.line(), HasSubstr(std::to_string(map_.cells[4].cell)));
  EXPECT_THAT(error.line(), HasSubstr("/areas/walls?bbox="));
  spoil_answers(is_cell_target, nullptr);
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  EXPECT_EQ(source->counters().tiles_from_cache, 3U);
}

TEST_F(HttpAreasTest, AnOldBuildIsGone) {
  answer_next("/builds/", {problem(410, "build 0011 was replaced")});
  const Error error = cells_error(*open_source(), kSouthWest);
  EXPECT_EQ(error.code, ErrorCode::gone);
  EXPECT_THAT(error.line(), HasSubstr("build 0011 was replaced"));
}

TEST_F(HttpAreasTest, WhatIsAbsentIsNotFound) {
  const auto source = open_source();
  const auto roofs = source->cells(map_.version(), "roofs", kEverything);
  ASSERT_FALSE(roofs.ok());
  EXPECT_EQ(roofs.error().code, ErrorCode::not_found);
  EXPECT_THAT(roofs.error().line(), HasSubstr("no layer \"roofs\""));
  // A layer of the map that has no cells.
  const auto tracklets = source->cells(map_.version(), "tracklets", kEverything);
  ASSERT_TRUE(tracklets.ok()) << tracklets.error().line();
  EXPECT_THAT(*tracklets, IsEmpty());
}

TEST_F(HttpAreasTest, ADamagedCellOfTheCacheIsFetchedAgain) {
  expect_cells(*open_source(), kSouthWest, {0, 1, 3, 4});
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((cache_ / "tiles-1.sqlite").c_str(), &database), SQLITE_OK);
  const std::string damage = "UPDATE entries SET content = zeroblob(bytes) WHERE number = " +
                             std::to_string(map_.cells[3].cell);
  EXPECT_EQ(sqlite3_exec(database, damage.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);
  const auto source = open_source();
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  EXPECT_THAT(cell_requests().back(),
              HasSubstr("/areas/walls/" + std::to_string(map_.cells[3].cell)));
}

TEST_F(HttpAreasTest, CellsDoNotStandInForTiles) {
  // A cell with the number of a tile and of the index of cells.
  map_.cells.resize(1);
  map_.cells[0].cell = 1;
  for (int round = 0; round < 2; ++round) {
    const auto source = open_source();
    expect_cells(*source, {-180, -90, 180, 90}, {0});
    EXPECT_EQ(source->describe(map_.version())->version, map_.version());
    const auto tiles = source->tiles(map_.version(), "s1", "tracklets", {30, 30});
    ASSERT_TRUE(tiles.ok()) << tiles.error().line();
    EXPECT_EQ(tiles->front().bytes, map_.encoded_tile(1));
  }
  EXPECT_EQ(server_.requests().size(), 6U);
}

TEST_F(HttpAreasTest, TheCatalogIsAskedOfTheServer) {
  const auto source = open_source();
  const auto maps = source->maps();
  ASSERT_TRUE(maps.ok()) << maps.error().line();
  EXPECT_THAT(*maps, ElementsAre(map_.version()));
  EXPECT_THAT(server_.requests(), ElementsAre("/v1/maps"));
}

TEST_F(HttpAreasTest, WithoutAServerTheCacheAnswers) {
  {
    const auto source = open_source();
    ASSERT_TRUE(source->describe(map_.version()).ok());
    expect_cells(*source, kEverything, {0, 1, 2, 3, 4, 5, 6, 7, 8});
  }
  const std::string url = server_.url();
  server_.stop();
  const auto source = open_source(url);
  EXPECT_THAT(*source->maps(), ElementsAre(map_.version()));
  const auto description = source->describe(map_.version());
  ASSERT_TRUE(description.ok());
  EXPECT_EQ(description->bounds.north_deg, 49.0018);
  expect_cells(*source, kSouthWest, {0, 1, 3, 4});
  EXPECT_THAT(pauses_s_, IsEmpty());
}

TEST_F(HttpAreasTest, WithoutAServerAndACacheTheUrlIsNamed) {
  const std::string url = server_.url();
  server_.stop();
  const auto source = open_source(url);
  const auto maps = source->maps();
  ASSERT_FALSE(maps.ok());
  EXPECT_EQ(maps.error().code, ErrorCode::unavailable);
  EXPECT_THAT(maps.error().line(), HasSubstr(url + "/v1/maps"));
  EXPECT_EQ(cells_error(*source, kSouthWest).code, ErrorCode::unavailable);
}

TEST_F(HttpAreasTest, TheDocumentsOutliveTheCells) {
  // Space for the documents and one or two cells: the rest is evicted repeatedly.
  cache_limit_bytes_ =
      map_.manifest().size() + map_.areas_document().size() + map_.map_document().size() + 1200;
  const auto source = open_source();
  ASSERT_TRUE(source->describe(map_.version()).ok());
  for (int i = 0; i < 3; ++i) {
    ++now_s_;
    expect_cells(*source, kEverything, {0, 1, 2, 3, 4, 5, 6, 7, 8});
  }
  const std::string url = server_.url();
  server_.stop();
  EXPECT_THAT(*open_source(url)->maps(), ElementsAre(map_.version()));
}

TEST_F(HttpAreasTest, SeveralThreadsShareASource) {
  const auto source = open_source();
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      expect_cells(*source, kSouthWest, {0, 1, 3, 4});
      expect_cells(*source, kEverything, {0, 1, 2, 3, 4, 5, 6, 7, 8});
      EXPECT_TRUE(source->maps().ok());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GE(source->counters().tiles_fetched, 9U);
}

}  // namespace
}  // namespace milepost::testing
