// The client in a network that answers in the server's place, with a login page for example.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <optional>
#include <string>
#include <vector>

#include "client/cache/tile_cache.h"
#include "tests/client/fetch/misbehaving_server.h"

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr Bounds kWholeMap{8, 48, 9, 50};
const GeoPoint kPosition{49.0001, 8.4, 0};
const char* const kPage = "<!DOCTYPE html><html><body>Welcome! Please log in.</body></html>";

// A foreign response to every request, and the reported error.
struct Portal {
  std::string name;
  ScriptedAnswer answer;
  std::string told = "something other than a milepost server answered";
};

ScriptedAnswer typed(int status, std::string body, const std::string& type) {
  return {.status = status, .body = std::move(body), .headers = {{"Content-Type", type}}};
}

std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

std::vector<Portal> portals() {
  const std::string html = "text/html; charset=utf-8";
  const std::string json = "application/json";
  const std::string problem = "application/problem+json";
  std::vector<Portal> all = {
      {"a page", typed(200, kPage, html)},
      {"a page that calls itself JSON", typed(200, kPage, json)},
      {"a page without a type", {.body = kPage}},
      {"nothing", {.body = ""}},
      {"no content", {.status = 204}},
      {"a page behind a redirect", {.status = 302, .headers = {{"Location", "/login"}}}},
      {"a loop of redirects", {.status = 302, .headers = {{"Location", "/loop"}}}},
      {"a redirect to an app", {.status = 302, .headers = {{"Location", "intent://login"}}}},
      {"a redirect to nowhere", {.status = 302}},
      {"other JSON", typed(200, R"({"status": "captive", "login": "http://x/"})", json)},
      {"a list", typed(200, "[]", json)},
      {"an empty object", typed(200, "{}", json)},
      {"JSON that ends early", typed(200, R"({"segments": [{"map": "town", )", json)},
      {"lists in lists", typed(200, nested(1000000), json)},
      {"lists that never end", typed(200, std::string(2000000, '['), json)},
      {"objects in objects", typed(200, std::string(500000, ' ') + R"({"a":)", json)},
      {"a problem too deep", typed(404, R"({"detail": )" + nested(7000) + "}", problem)},
      {"a problem that is a page", typed(404, kPage, problem)},
      {"JSON that is no problem", typed(410, R"({"detail": "log in"})", json)},
      {"a server that is unavailable", typed(503, kPage, html), "unavailable"},
  };
  for (const int status : {400, 401, 403, 404, 405, 407, 410, 451, 511}) {
    all.push_back({"a page with status " + std::to_string(status), typed(status, kPage, html)});
  }
  return all;
}

class PortalTest : public MisbehavingServerTest {
 protected:
  // Loads the map data that the vehicle needs into the cache.
  void warm_the_cache() {
    const auto source = open_source();
    ASSERT_TRUE(source->describe(map_.version()).ok());
    ASSERT_TRUE(source->tiles(map_.version(), "s1", "tracklets", {0, 100}).ok());
    ASSERT_TRUE(source->cells(map_.version(), "walls", kWholeMap).ok());
  }

  // Expects that everything cached is found.
  void expect_all(MapSource& source) const {
    const auto near = source.segments_near(kPosition, 50);
    ASSERT_TRUE(near.ok()) << near.error().line();
    ASSERT_EQ(near->size(), 1U);
    EXPECT_EQ(near->front().version, map_.version());
    EXPECT_EQ(near->front().segment, "s1");
    const auto maps = source.maps();
    ASSERT_TRUE(maps.ok()) << maps.error().line();
    EXPECT_THAT(*maps, ElementsAre(map_.version()));
    const auto description = source.describe(map_.version());
    ASSERT_TRUE(description.ok()) << description.error().line();
    EXPECT_EQ(*description->feature, FeatureParameters());
    const auto segment = source.segment(map_.version(), "s1");
    ASSERT_TRUE(segment.ok()) << segment.error().line();
    EXPECT_EQ(segment->length_m, 200);
    const auto tiles = source.tiles(map_.version(), "s1", "tracklets", {0, 100});
    ASSERT_TRUE(tiles.ok()) << tiles.error().line();
    for (const EncodedTile& tile : *tiles) EXPECT_EQ(tile.bytes, map_.encoded_tile(tile.index));
    const auto cells = source.cells(map_.version(), "walls", kWholeMap);
    ASSERT_TRUE(cells.ok()) << cells.error().line();
    EXPECT_EQ(cells->size(), map_.cells.size());
  }

  // Expects an error with the address, the kind of response and a hint.
  static void expect_told(const Error& error, const std::string& address, const Portal& portal) {
    EXPECT_EQ(error.code, ErrorCode::unavailable);
    EXPECT_THAT(error.line(), HasSubstr(address));
    EXPECT_THAT(error.line(), HasSubstr(portal.told));
    EXPECT_FALSE(error.hint.empty());
    EXPECT_LT(error.line().size(), 600U);
  }

  std::int64_t entries_of_the_cache() const {
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open((cache_ / "tiles-1.sqlite").c_str(), &database), SQLITE_OK);
    sqlite3_stmt* count = nullptr;
    sqlite3_prepare_v2(database, "SELECT count(*) FROM entries", -1, &count, nullptr);
    EXPECT_EQ(sqlite3_step(count), SQLITE_ROW);
    const std::int64_t entries = sqlite3_column_int64(count, 0);
    sqlite3_finalize(count);
    sqlite3_close(database);
    return entries;
  }
};

TEST_F(PortalTest, WithAWarmCacheItIsLikeNoNetwork) {
  warm_the_cache();
  const std::int64_t entries = entries_of_the_cache();
  for (const Portal& portal : portals()) {
    SCOPED_TRACE(portal.name);
    answer_all(portal.answer);
    const auto source = open_source();
    expect_all(*source);
    // The nearby segments and the catalog are requested once, not at every frame.
    const std::uint64_t asked = source->counters().requests;
    EXPECT_LE(asked, 2U);
    for (int frame = 0; frame < 10; ++frame) expect_all(*source);
    EXPECT_EQ(source->counters().requests, asked);
    EXPECT_TRUE(pauses_s_.empty());
    answer_all(std::nullopt);
  }
  EXPECT_EQ(entries_of_the_cache(), entries);
  EXPECT_EQ(open_source()->segments_near(kPosition, 50)->front().distance_m, 1.25);  // the server's
}

TEST_F(PortalTest, WithAColdCacheTheUserIsToldWhatAnswered) {
  for (const Portal& portal : portals()) {
    SCOPED_TRACE(portal.name);
    answer_all(portal.answer);
    const auto source = open_source();
    expect_told(source->segments_near(kPosition, 50).error(),
                server_.url() + "/v1/segments?near=", portal);
    expect_told(source->maps().error(), server_.url() + "/v1/maps", portal);
    expect_told(source->describe(map_.version()).error(), "/manifest", portal);
    expect_told(source->segment(map_.version(), "s1").error(), "/manifest", portal);
    expect_told(source->cells(map_.version(), "walls", kWholeMap).error(), "/manifest", portal);
    answer_all(std::nullopt);
  }
  EXPECT_EQ(entries_of_the_cache(), 0);
}

TEST_F(PortalTest, WhatItSendsForTilesIsNeitherTakenNorKept) {
  warm_the_cache();
  const std::int64_t entries = entries_of_the_cache();
  for (const Portal& portal : portals()) {
    SCOPED_TRACE(portal.name);
    answer_all(portal.answer);
    const auto source = open_source();
    const auto ahead = source->tiles(map_.version(), "s1", "tracklets", {0, 200});
    ASSERT_FALSE(ahead.ok());
    const bool as_none =
        ahead.error().code == ErrorCode::unavailable || ahead.error().code == ErrorCode::corrupt;
    EXPECT_TRUE(as_none) << ahead.error().line();
    EXPECT_THAT(ahead.error().line(), HasSubstr("/tiles"));
    expect_all(*source);
    answer_all(std::nullopt);
  }
  EXPECT_EQ(entries_of_the_cache(), entries);
  EXPECT_TRUE(open_source()->tiles(map_.version(), "s1", "tracklets", {0, 200}).ok());
}

TEST_F(PortalTest, WhenItOpensTheServerIsHeardAgain) {
  warm_the_cache();
  answer_all(typed(200, kPage, "text/html"));
  const auto source = open_source();
  EXPECT_LT(source->segments_near(kPosition, 50)->front().distance_m, 0.1);  // from the cache
  answer_all(std::nullopt);
  now_s_ += 6;
  EXPECT_EQ(source->segments_near(kPosition, 50)->front().distance_m, 1.25);
}

TEST_F(PortalTest, TheServersOwnRefusalsKeepTheirMeaning) {
  warm_the_cache();
  const auto source = open_source();
  answer_all(problem(400, "radius_m is no number"));
  const auto near = source->segments_near(kPosition, 50);
  ASSERT_FALSE(near.ok());
  EXPECT_EQ(near.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(near.error().line(), HasSubstr("radius_m is no number"));
  answer_all(problem(410, "go on with another"));
  EXPECT_EQ(source->tiles(map_.version(), "s1", "tracklets", {0, 200}).error().code,
            ErrorCode::gone);
  answer_all(problem(404, "no such segment"));
  EXPECT_EQ(source->segment(map_.version(), "s9").error().code, ErrorCode::not_found);
}

// A document nested so deeply that recursing through it would exhaust the stack.
TEST_F(PortalTest, ADeepMapDocumentIsNoAnswer) {
  for (const std::string member : {"\"feature\":", "\"more\":"}) {
    std::string deep = map_.map_document();
    std::string value;
    for (int i = 0; i < 100000; ++i) value += R"({"a":)";
    value += "1" + std::string(100000, '}');
    deep.insert(1, member + value + ",");
    answer_next("/map", std::vector<ScriptedAnswer>(6, {.body = deep}));
    const auto description = open_source()->describe(map_.version());
    ASSERT_FALSE(description.ok());
    EXPECT_EQ(description.error().code, ErrorCode::unavailable);
  }
  EXPECT_TRUE(open_source()->describe(map_.version()).ok());
}

TEST_F(PortalTest, ADeepDocumentInTheCacheIsFetchedAgain) {
  warm_the_cache();
  // With its digest, as stored by an earlier version.
  const std::string deep = nested(1000000);
  const auto cache = std::move(TileCache::open({.folder = cache_.path()})).value();
  cache->store(CacheKey::map_document("town", map_.build()), as_bytes(deep));
  cache->store(CacheKey::areas_document("town", map_.build()), as_bytes(deep));
  cache->store(CacheKey::segment_document("town", map_.build(), "s1"), as_bytes(deep));
  {
    answer_all(ScriptedAnswer{.status = 503});
    const auto source = open_source();
    EXPECT_EQ(source->segments_near(kPosition, 50).error().code, ErrorCode::unavailable);
    answer_all(std::nullopt);
  }
  expect_all(*open_source());
}

}  // namespace
}  // namespace milepost::testing
