#include "client/fetch/http_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <thread>
#include <vector>

#include "tests/client/fetch/misbehaving_server.h"

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class HttpSourceTest : public MisbehavingServerTest {
 protected:
  // Modifies every response to a tile request.
  void spoil_tiles(std::function<void(std::string& body)> spoil) {
    spoil_answers(is_tile_target, std::move(spoil));
  }

  std::vector<std::string> tile_requests() const { return requests(is_tile_target); }

  void expect_tiles(MapSource& source, const AlongRange& range,
                    const std::vector<std::uint32_t>& indices) const {
    const auto tiles = source.tiles(map_.version(), "s1", "tracklets", range);
    ASSERT_TRUE(tiles.ok()) << tiles.error().line();
    std::vector<std::uint32_t> answered;
    for (const EncodedTile& tile : *tiles) {
      answered.push_back(tile.index);
      EXPECT_EQ(tile.bytes, map_.encoded_tile(tile.index)) << tile.index;
    }
    EXPECT_EQ(answered, indices);
  }

  Error tiles_error(MapSource& source, const AlongRange& range) const {
    const auto tiles = source.tiles(map_.version(), "s1", "tracklets", range);
    if (tiles.ok()) ADD_FAILURE() << "the tiles came";
    return tiles.ok() ? Error{} : tiles.error();
  }
};

TEST_F(HttpSourceTest, AColdFetchBringsARangeInOneRequest) {
  const auto source = open_source();
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  // The narrowest range that meets tiles 1 to 4: from the end of 1 to the beginning of 4.
  EXPECT_THAT(tile_requests(), ElementsAre(HasSubstr("from_m=45&to_m=80")));
  EXPECT_EQ(server_.requests().size(), 3U);  // with the manifest and the segment's document
  const SourceCounters counters = source->counters();
  EXPECT_EQ(counters.requests, 3U);
  EXPECT_EQ(counters.tiles_fetched, 4U);
  EXPECT_EQ(counters.tiles_from_cache, 0U);
  const std::size_t tile_bytes = 1010 + 1020 + 1030 + 1040;
  EXPECT_EQ(counters.bytes_received,
            map_.manifest().size() + map_.segment_document().size() + tile_bytes);
  EXPECT_EQ(counters.cache_failures, 0U);
}

TEST_F(HttpSourceTest, AWarmCacheNeedsNoRequest) {
  expect_tiles(*open_source(), {30, 90}, {1, 2, 3, 4});
  const std::size_t before = server_.requests().size();
  const auto source = open_source();
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  EXPECT_EQ(server_.requests().size(), before);
  EXPECT_EQ(source->counters().tiles_from_cache, 4U);
  EXPECT_EQ(source->counters().requests, 0U);
}

TEST_F(HttpSourceTest, OnlyTheGapIsFetched) {
  const auto source = open_source();
  expect_tiles(*source, {30, 30}, {1});
  expect_tiles(*source, {110, 110}, {5});
  expect_tiles(*source, {30, 110}, {1, 2, 3, 4, 5});
  EXPECT_THAT(tile_requests(),
              ElementsAre(HasSubstr("/tiles/tracklets/1"), HasSubstr("/tiles/tracklets/5"),
                          HasSubstr("from_m=65&to_m=80")));
  EXPECT_EQ(source->counters().tiles_from_cache, 2U);
  EXPECT_EQ(source->counters().tiles_fetched, 5U);
}

TEST_F(HttpSourceTest, TwoGapsAreTwoRequests) {
  const auto source = open_source();
  expect_tiles(*source, {90, 90}, {4});
  expect_tiles(*source, {0, 195}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  EXPECT_THAT(tile_requests(),
              ElementsAre(HasSubstr("/tiles/tracklets/4"), HasSubstr("from_m=25&to_m=60"),
                          HasSubstr("from_m=125&to_m=180")));
}

TEST_F(HttpSourceTest, ARangeBesideAllTilesIsAnEmptyAnswer) {
  const auto source = open_source();
  expect_tiles(*source, {300, 400}, {});
  EXPECT_THAT(tile_requests(), IsEmpty());
}

TEST_F(HttpSourceTest, AfterABreakOffOnlyTheRestIsAskedFor) {
  const std::string body = map_.range_body({45, 80});
  answer_next("from_m", {{.body = body, .break_off_after = 1010 + 1020 + 7}});
  const auto source = open_source();
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  EXPECT_THAT(tile_requests(),
              ElementsAre(HasSubstr("from_m=45&to_m=80"), HasSubstr("from_m=80&to_m=80")));
  EXPECT_THAT(pauses_s_, IsEmpty());
  EXPECT_EQ(source->counters().tiles_fetched, 4U);
}

TEST_F(HttpSourceTest, WhatABreakOffLeftIsKeptForTheNextRun) {
  const std::string body = map_.range_body({45, 80});
  answer_next("from_m", {{.body = body, .break_off_after = 1010 + 1020 + 7},
                         {.status = 503},
                         {.status = 503},
                         {.status = 503}});
  EXPECT_EQ(tiles_error(*open_source(), {30, 90}).code, ErrorCode::unavailable);
  const auto source = open_source();
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  EXPECT_EQ(source->counters().tiles_from_cache, 2U);
  EXPECT_EQ(source->counters().tiles_fetched, 2U);
}

TEST_F(HttpSourceTest, ABreakOffWithoutAWholeTileIsTriedAgainAfterAPause) {
  const ScriptedAnswer broken = {.body = map_.range_body({45, 80}), .break_off_after = 500};
  answer_next("from_m", {broken, broken, broken});
  const Error error = tiles_error(*open_source(), {30, 90});
  EXPECT_EQ(error.code, ErrorCode::unavailable);
  EXPECT_THAT(error.line(), HasSubstr(server_.url()));
  EXPECT_EQ(tile_requests().size(), 3U);
  EXPECT_THAT(pauses_s_, ElementsAre(0.25, 0.5));
}

TEST_F(HttpSourceTest, AWrongByteIsRefusedAndNotStored) {
  spoil_tiles([](std::string& body) { body[1010 + 1020 + 5] ^= 1; });  // in tile 3
  const auto source = open_source();
  const Error error = tiles_error(*source, {30, 90});
  EXPECT_EQ(error.code, ErrorCode::corrupt);
  EXPECT_THAT(error.line(), HasSubstr("tile 3"));
  EXPECT_THAT(error.line(), HasSubstr(server_.url() + "/v1/maps/town/builds/"));
  EXPECT_EQ(tile_requests().size(), 2U);  // the second one past caches
  EXPECT_EQ(server_.cache_control(), "no-cache");
  EXPECT_THAT(pauses_s_, IsEmpty());

  spoil_tiles(nullptr);
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  EXPECT_THAT(tile_requests().back(), HasSubstr("from_m=80&to_m=80"));  // 1 and 2 were complete
}

TEST_F(HttpSourceTest, HostileAnswersAreRefused) {
  const std::string good = map_.range_body({45, 80});
  const auto without_the_first = good.substr(1010);
  const std::vector<std::pair<std::string, std::string>> bodies = {
      {"empty", ""},
      {"last tile missing", good.substr(0, 1010 + 1020 + 1030)},
      {"last byte missing", good.substr(0, good.size() - 1)},
      {"first tile missing", without_the_first},
      {"one byte more", good + "x"},
      {"a tile more", good + std::string(as_text(map_.encoded_tile(5)))},
      {"other order", without_the_first + good.substr(0, 1010)},
      {"the same tile again", good.substr(0, 1010) + good},
      {"something else", std::string(100000, 'x')},
      {"zeros", std::string(good.size(), '\0')},
  };
  for (const auto& [name, body] : bodies) {
    SCOPED_TRACE(name);
    const TempFolder fresh;
    answer_next("from_m", {{.body = body}, {.body = body}});
    HttpSourceSettings settings;
    settings.server_url = server_.url();
    settings.cache_directory = fresh.path();
    const auto source = std::move(open_http_source(settings)).value();
    const Error error = tiles_error(*source, {30, 90});
    EXPECT_EQ(error.code, ErrorCode::corrupt) << error.line();
    EXPECT_THAT(error.line(), HasSubstr("from_m=45"));
    expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  }
}

TEST_F(HttpSourceTest, AHostileSingleTileIsRefused) {
  const ScriptedAnswer other = {.body = std::string(as_text(map_.encoded_tile(2)))};
  answer_next("/tiles/tracklets/1", {other, other});
  EXPECT_EQ(tiles_error(*open_source(), {30, 30}).code, ErrorCode::corrupt);
}

TEST_F(HttpSourceTest, AnOldBuildIsGone) {
  answer_next("/builds/", {problem(410, "build 0011 was replaced")});
  const auto segment = open_source()->segment(map_.version(), "s1");
  ASSERT_FALSE(segment.ok());
  EXPECT_EQ(segment.error().code, ErrorCode::gone);
  EXPECT_THAT(segment.error().line(), HasSubstr("the map was rebuilt"));
  EXPECT_THAT(segment.error().line(), HasSubstr("build 0011 was replaced"));
  EXPECT_THAT(pauses_s_, IsEmpty());
}

TEST_F(HttpSourceTest, TheDescriptionOfAnOldBuildIsGone) {
  const auto source = open_source();
  const MapVersion old{"town", std::string(32, 'a')};
  const auto description = source->describe(old);
  ASSERT_FALSE(description.ok());
  EXPECT_EQ(description.error().code, ErrorCode::gone);
  EXPECT_THAT(description.error().line(), HasSubstr("the map was rebuilt"));
  EXPECT_THAT(server_.requests(), ElementsAre(HasSubstr("/manifest")));
}

TEST_F(HttpSourceTest, ABusyServerIsAskedAgainWhenItSays) {
  answer_next("/segments/s1", {{.status = 503, .headers = {{"Retry-After", "2"}}}});
  EXPECT_TRUE(open_source()->segment(map_.version(), "s1").ok());
  EXPECT_THAT(pauses_s_, ElementsAre(2));
  EXPECT_EQ(server_.requests().size(), 3U);
}

TEST_F(HttpSourceTest, APauseWithoutReasonIsCutShort) {
  answer_next("/segments/s1", {{.status = 503, .headers = {{"Retry-After", "86400"}}}});
  EXPECT_TRUE(open_source()->segment(map_.version(), "s1").ok());
  EXPECT_THAT(pauses_s_, ElementsAre(10));
}

TEST_F(HttpSourceTest, WithoutAServerTheCacheAnswers) {
  {
    const auto source = open_source();
    EXPECT_TRUE(source->describe(map_.version()).ok());
    expect_tiles(*source, {0, 200}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  }
  const std::string url = server_.url();
  server_.stop();
  const auto source = open_source(url);
  expect_tiles(*source, {0, 200}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  const auto description = source->describe(map_.version());
  ASSERT_TRUE(description.ok());
  EXPECT_EQ(description->version, map_.version());
  EXPECT_EQ(description->layers.at("tracklets")->focal_px(), 600);
  EXPECT_EQ(*description->feature, FeatureParameters());

  const auto near = source->segments_near({49.00045, 8.40001, 0}, 5);
  ASSERT_TRUE(near.ok()) << near.error().line();
  ASSERT_EQ(near->size(), 1U);
  EXPECT_EQ(near->front().version, map_.version());
  EXPECT_EQ(near->front().segment, "s1");
  EXPECT_EQ(near->front().length_m, 200);
  EXPECT_NEAR(near->front().along_m, 50.04, 0.1);
  EXPECT_NEAR(near->front().distance_m, 0.73, 0.01);
  EXPECT_THAT(pauses_s_, IsEmpty());  // no waiting for a server that is not needed

  // An empty result of the cache is not reported as an empty list.
  const auto far = source->segments_near({50, 8.4, 0}, 5);
  ASSERT_FALSE(far.ok());
  EXPECT_EQ(far.error().code, ErrorCode::unavailable);
}

TEST_F(HttpSourceTest, AServerThatIsAwayIsNotAskedForWhatIsKnownAtEveryFrame) {
  const GeoPoint position{49.0001, 8.4, 0};
  const auto source = open_source();
  ASSERT_TRUE(source->segment(map_.version(), "s1").ok());
  const ScriptedAnswer busy = {.status = 503};
  answer_next("/v1/segments?", {busy, busy, busy});
  const std::size_t before = server_.requests().size();
  for (int frame = 0; frame < 10; ++frame) {
    EXPECT_LT(source->segments_near(position, 50)->front().distance_m, 0.1);  // from the cache
  }
  EXPECT_EQ(server_.requests().size(), before + 1);
  now_s_ += 6;
  EXPECT_LT(source->segments_near(position, 50)->front().distance_m, 0.1);
  EXPECT_EQ(server_.requests().size(), before + 2);
}

TEST_F(HttpSourceTest, SegmentsFetchedLaterAreKnownToo) {
  const GeoPoint position{49.0001, 8.4, 0};
  const auto source = open_source();
  const ScriptedAnswer busy = {.status = 503};
  answer_next("/v1/segments?", {busy, busy, busy, busy});
  EXPECT_EQ(source->segments_near(position, 50).error().code, ErrorCode::unavailable);
  ASSERT_TRUE(source->segment(map_.version(), "s1").ok());
  const auto near = source->segments_near(position, 50);
  ASSERT_TRUE(near.ok()) << near.error().line();
  EXPECT_LT(near->front().distance_m, 0.1);  // from the cache, not the server's 1.25
}

TEST_F(HttpSourceTest, WhatTheServerSaysRenewsWhatIsKnown) {
  const GeoPoint position{49.0001, 8.4, 0};
  const auto source = open_source();
  ASSERT_TRUE(source->segment(map_.version(), "s1").ok());
  answer_next("/v1/segments?", {{.status = 503}});
  EXPECT_TRUE(source->segments_near(position, 50).ok());
  // Another process stores a newer build in the cache, which becomes known here later.
  map_.index.pop_back();
  now_s_ += 6;
  ASSERT_TRUE(open_source()->segment(map_.version(), "s1").ok());
  EXPECT_EQ(source->segments_near(position, 50)->front().version, map_.version());
  answer_next("/v1/segments?", {{.status = 503}});
  const auto near = source->segments_near(position, 50);
  ASSERT_TRUE(near.ok()) << near.error().line();
  EXPECT_EQ(near->front().version, map_.version());
}

TEST_F(HttpSourceTest, WithoutAServerAndACacheTheUrlIsNamed) {
  const std::string url = server_.url();
  server_.stop();
  const auto source = open_source(url + "/");
  const auto near = source->segments_near({49, 8.4, 0}, 50);
  ASSERT_FALSE(near.ok());
  EXPECT_EQ(near.error().code, ErrorCode::unavailable);
  EXPECT_THAT(near.error().line(), HasSubstr(url + "/v1/segments?near=49,8.4&radius_m=50"));
  EXPECT_THAT(pauses_s_, ElementsAre(0.25, 0.5));
  EXPECT_EQ(source->segment(map_.version(), "s1").error().code, ErrorCode::unavailable);
  EXPECT_EQ(source->describe(map_.version()).error().code, ErrorCode::unavailable);
  EXPECT_EQ(source->counters().requests, 9U);
}

TEST_F(HttpSourceTest, SegmentsNearAsksTheServer) {
  const auto source = open_source();
  const auto near = source->segments_near({49.00045, 8.40001, 0}, 20.5);
  ASSERT_TRUE(near.ok());
  ASSERT_EQ(near->size(), 1U);
  EXPECT_EQ(near->front().version, map_.version());
  EXPECT_EQ(near->front().segment, "s1");
  EXPECT_EQ(near->front().along_m, 50);
  EXPECT_EQ(near->front().distance_m, 1.25);
  EXPECT_THAT(server_.requests(), ElementsAre("/v1/segments?near=49.00045,8.40001&radius_m=20.5"));
}

TEST_F(HttpSourceTest, AWrongPositionIsRefusedBeforeTheServerIsAsked) {
  const auto source = open_source();
  for (const GeoPoint& position : {GeoPoint{91, 0, 0}, GeoPoint{0, std::nan(""), 0}}) {
    const auto near = source->segments_near(position, 5);
    ASSERT_FALSE(near.ok());
    EXPECT_EQ(near.error().code, ErrorCode::invalid_input);
  }
  EXPECT_FALSE(source->segments_near({49, 8.4, 0}, -1).ok());
  EXPECT_THAT(server_.requests(), IsEmpty());
}

TEST_F(HttpSourceTest, TheSegmentIsDescribed) {
  const auto source = open_source();
  const auto segment = source->segment(map_.version(), "s1");
  ASSERT_TRUE(segment.ok());
  EXPECT_EQ(segment->id, "s1");
  EXPECT_EQ(segment->length_m, 200);
  ASSERT_EQ(segment->vertices.size(), 3U);
  EXPECT_EQ(segment->vertices[1], (GeoPoint{49.0009, 8.4, 110}));
  EXPECT_THAT(segment->successors,
              ElementsAre(Successor{"s2", "town"}, Successor{"s9", "village"}));
  EXPECT_THAT(segment->passes, ElementsAre(StoredPass{"morning", 40, 240}));
  EXPECT_EQ(segment->position_error, (PositionError{0.15, 100, true}));
  EXPECT_EQ(*source->layer_bytes(map_.version(), "s1", "tracklets"), 10U * 1000 + 10 * 45);
}

TEST_F(HttpSourceTest, WhatIsAbsentIsNotFound) {
  const auto source = open_source();
  const auto segment = source->segment(map_.version(), "s9");
  ASSERT_FALSE(segment.ok());
  EXPECT_EQ(segment.error().code, ErrorCode::not_found);
  EXPECT_THAT(segment.error().line(), HasSubstr("/segments/s9"));
  EXPECT_THAT(segment.error().line(), HasSubstr("the build does not have this segment"));

  const auto unknown_layer = source->tiles(map_.version(), "s1", "clouds", {0, 10});
  ASSERT_FALSE(unknown_layer.ok());
  EXPECT_EQ(unknown_layer.error().code, ErrorCode::not_found);
  // A layer of the map without anything on this segment.
  const auto walls = source->tiles(map_.version(), "s1", "walls", {0, 10});
  ASSERT_TRUE(walls.ok());
  EXPECT_THAT(*walls, IsEmpty());
}

TEST_F(HttpSourceTest, AWrongDocumentIsNotBelievedAndNotStored) {
  const ScriptedAnswer wrong = {.body = R"({"segment": "s9"})"};
  answer_next("/segments/s1", std::vector<ScriptedAnswer>(6, wrong));
  const auto source = open_source();
  const auto segment = source->segment(map_.version(), "s1");
  ASSERT_FALSE(segment.ok());
  EXPECT_EQ(segment.error().code, ErrorCode::unavailable);
  EXPECT_THAT(segment.error().line(), HasSubstr("/segments/s1"));
  EXPECT_THAT(segment.error().line(), HasSubstr("about \"s9\""));
  EXPECT_TRUE(source->segment(map_.version(), "s1").ok());
}

TEST_F(HttpSourceTest, ADamagedTileOfTheCacheIsFetchedAgain) {
  expect_tiles(*open_source(), {30, 90}, {1, 2, 3, 4});
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((cache_ / "tiles-1.sqlite").c_str(), &database), SQLITE_OK);
  const char* damage = "UPDATE entries SET content = zeroblob(bytes) WHERE number = 3";
  EXPECT_EQ(sqlite3_exec(database, damage, nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);
  const auto source = open_source();
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  EXPECT_THAT(tile_requests().back(), HasSubstr("/tiles/tracklets/3"));
  EXPECT_EQ(source->counters().tiles_from_cache, 3U);
}

TEST_F(HttpSourceTest, ADamagedCacheFileIsFilledAgain) {
  expect_tiles(*open_source(), {30, 90}, {1, 2, 3, 4});
  std::ofstream(cache_ / "tiles-1.sqlite") << std::string(50000, 'x');
  expect_tiles(*open_source(), {30, 90}, {1, 2, 3, 4});
  EXPECT_EQ(tile_requests().size(), 2U);
  expect_tiles(*open_source(), {30, 90}, {1, 2, 3, 4});
  EXPECT_EQ(tile_requests().size(), 2U);
}

TEST_F(HttpSourceTest, WorksWithACacheThatHoldsNothing) {
  cache_limit_bytes_ = 0;
  const auto source = open_source();
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  expect_tiles(*source, {30, 90}, {1, 2, 3, 4});
  EXPECT_EQ(source->counters().tiles_from_cache, 0U);
  EXPECT_EQ(server_.requests().size(), 4U);  // the documents stay in memory
}

TEST_F(HttpSourceTest, SeveralThreadsShareASource) {
  const auto source = open_source();
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::uint32_t k = 0; k < 9; ++k) {
        expect_tiles(*source, {20.0 * k + 10, 20.0 * k + 30}, {k, k + 1});
      }
      EXPECT_TRUE(source->segments_near({49, 8.4, 0}, 5.0 + t).ok());
      EXPECT_TRUE(source->describe(map_.version()).ok());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GE(source->counters().tiles_fetched, 10U);
}

TEST(OpenHttpSource, RefusesWhatIsNoServersUrl) {
  const TempFolder folder;
  for (const std::string url : {"", "host:80", "ftp://host", "file:///etc/passwd", "http://",
                                "http://host/?query=1", "not a url"}) {
    HttpSourceSettings settings;
    settings.server_url = url;
    settings.cache_directory = folder.path();
    const auto source = open_http_source(settings);
    ASSERT_FALSE(source.ok()) << url;
    EXPECT_EQ(source.error().code, ErrorCode::invalid_input);
  }
}

TEST(OpenHttpSource, RefusesACacheFolderThatCannotBe) {
  const TempFolder folder;
  std::ofstream(folder / "file") << "x";
  HttpSourceSettings settings;
  settings.server_url = "http://127.0.0.1:1";
  settings.cache_directory = folder / "file" / "cache";
  const auto source = open_http_source(settings);
  ASSERT_FALSE(source.ok());
  EXPECT_EQ(source.error().code, ErrorCode::io);
}

}  // namespace
}  // namespace milepost::testing
