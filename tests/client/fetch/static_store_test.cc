// The client and a store of plain files, which ignores queries and knows no folders.
#include "client/fetch/static_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/client/fetch/misbehaving_server.h"

namespace milepost::testing {
namespace {

using nlohmann::json;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr GeoPoint kBesideTheSegment{49.00045, 8.4001, 0};  // 50 m along

bool is_any(const std::string& /*target*/) { return true; }
bool is_near_query(const std::string& target) { return target.starts_with("/v1/segments"); }
bool is_query(const std::string& target) {
  return target.find('?') != std::string::npos && !is_near_query(target);
}

class StaticStoreTest : public ::testing::Test {
 protected:
  std::shared_ptr<MapSource> open_source() {
    HttpSourceSettings settings;
    settings.server_url = store_.url();
    settings.cache_directory = cache_.path();
    settings.attempts = 2;
    HttpSourceParts parts;
    parts.transport = make_curl_transport({5, 10});
    parts.sleep = [](double, const Stopped&) {};
    parts.steady_s = [this] { return now_s_.load(); };
    return std::move(make_http_source(settings, std::move(parts))).value();
  }

  std::vector<std::string> requests(bool (*kind)(const std::string&)) const {
    std::vector<std::string> targets = store_.requests();
    std::erase_if(targets, [kind](const std::string& target) { return !kind(target); });
    return targets;
  }

  json placed(const std::string& segment, double north_deg) const {
    return {{"map", "town"},
            {"build", map_.build()},
            {"segment", segment},
            {"bounds",
             {{"west_deg", 8.4},
              {"south_deg", 49 + north_deg},
              {"east_deg", 8.4},
              {"north_deg", 49.0018 + north_deg}}}};
  }

  FakeMap map_;
  TempFolder cache_;
  std::atomic<bool> is_static_ = true;
  json segments_ = {placed("s1", 0), placed("far", 1)};
  std::string spoilt_;  // targets that contain it get another byte; none if empty
  std::atomic<std::int64_t> now_s_ = 1000;

 private:
  ScriptedAnswer answer(const std::string& target) const {
    if (!is_static_) return map_.answer(target);
    ScriptedAnswer sent = answer_of_key(target.substr(0, target.find('?')));
    if (!spoilt_.empty() && target.find(spoilt_) != std::string::npos) sent.body[20] ^= 1;
    return sent;
  }

  ScriptedAnswer answer_of_key(const std::string& key) const {
    const std::string index = "/index.json";
    if (key == "/v1/segments") return document({{"segments", segments_}, {"static", true}});
    if (key == "/v1/maps" + index) {
      json maps = json::parse(map_.catalog_document());
      maps["static"] = true;
      return document(maps);
    }
    const bool is_index = key.ends_with(index);
    const std::string url = is_index ? key.substr(0, key.size() - index.size()) : key;
    const bool needs_index = url.ends_with("/segments/s1") || url.ends_with("/areas");
    const ScriptedAnswer found = map_.answer(url);
    if (found.status == 200 && is_index == needs_index && key != "/v1/maps") return found;
    return {.status = 403,
            .body = "<Error><Code>AccessDenied</Code></Error>",
            .headers = {{"Content-Type", "application/xml"}}};
  }

  static ScriptedAnswer document(const json& content) { return {.body = content.dump()}; }

 protected:
  ScriptedServer store_{[this](const std::string& target) { return answer(target); }};
};

TEST_F(StaticStoreTest, TheSegmentsNearbyAreFoundByTheirDocuments) {
  const auto source = open_source();
  const auto near = source->segments_near(kBesideTheSegment, 50);
  ASSERT_TRUE(near.ok()) << near.error().line();
  ASSERT_EQ(near->size(), 1U);
  EXPECT_EQ(near->front().version, map_.version());
  EXPECT_EQ(near->front().segment, "s1");
  EXPECT_NEAR(near->front().along_m, 50, 0.1);
  EXPECT_NEAR(near->front().distance_m, 7.3, 0.1);
  EXPECT_EQ(near->front().length_m, 200);
  EXPECT_THAT(*source->segments_near({49.5, 8.4, 0}, 50), IsEmpty());
}

TEST_F(StaticStoreTest, DocumentsOfSegmentsOutOfReachAreNotRequested) {
  segments_ = {placed("s1", 0.01)};  // 1.1 km to the north
  EXPECT_THAT(*open_source()->segments_near(kBesideTheSegment, 50), IsEmpty());
  EXPECT_THAT(requests(is_any), SizeIs(1));
}

TEST_F(StaticStoreTest, TheListIsKeptForAMinute) {
  const auto source = open_source();
  EXPECT_THAT(*source->segments_near(kBesideTheSegment, 50), SizeIs(1));
  now_s_ += 59;
  EXPECT_THAT(*source->segments_near({49.0009, 8.4001, 0}, 50), SizeIs(1));
  EXPECT_THAT(requests(is_near_query), SizeIs(1));
  now_s_ += 1;
  EXPECT_THAT(*source->segments_near({49.0009, 8.4001, 0}, 50), SizeIs(1));
  EXPECT_THAT(requests(is_near_query), SizeIs(2));
}

TEST_F(StaticStoreTest, TilesAreRequestedOneByOne) {
  const auto source = open_source();
  ASSERT_TRUE(source->segments_near(kBesideTheSegment, 50).ok());
  const auto tiles = source->tiles(map_.version(), "s1", "tracklets", {30, 90});
  ASSERT_TRUE(tiles.ok()) << tiles.error().line();
  EXPECT_THAT(*tiles, SizeIs(4));
  EXPECT_THAT(requests(is_tile_target),
              ElementsAre(HasSubstr("/tracklets/1"), HasSubstr("/tracklets/2"),
                          HasSubstr("/tracklets/3"), HasSubstr("/tracklets/4")));
  EXPECT_THAT(requests(is_query), IsEmpty());
}

TEST_F(StaticStoreTest, OneRequestForTheProviderIsOneTile) {
  const auto source = open_source()->until({}, MapSource::Asking::once);
  ASSERT_TRUE(source->segments_near(kBesideTheSegment, 50).ok());
  std::vector<std::uint32_t> taken;
  const auto index = *source->tile_index(map_.version(), "s1", "tracklets");
  const Attempt attempt =
      source->fetch_tiles(map_.version(), "s1", "tracklets", index,
                          [&](const EncodedTile& tile) { taken.push_back(tile.index); });
  EXPECT_TRUE(attempt.status.ok());
  EXPECT_THAT(taken, ElementsAre(0));
}

// The first request of a vehicle without a position.
TEST_F(StaticStoreTest, TheCatalogIsFoundBesideItsUrl) {
  const auto source = open_source();
  EXPECT_THAT(*source->maps(), ElementsAre(map_.version()));
  EXPECT_THAT(requests(is_any), ElementsAre("/v1/maps", "/v1/maps/index.json"));
  const auto cells = source->cells(map_.version(), "walls", {8.3, 48.9, 8.6, 49.1});
  ASSERT_TRUE(cells.ok()) << cells.error().line();
  EXPECT_THAT(*cells, SizeIs(9));
  EXPECT_THAT(requests(is_cell_target), SizeIs(10));  // with their index
  EXPECT_THAT(requests(is_query), IsEmpty());
}

TEST_F(StaticStoreTest, AServerIsNotAskedForFiles) {
  is_static_ = false;
  const auto source = open_source();
  EXPECT_THAT(*source->maps(), SizeIs(1));
  EXPECT_THAT(*source->segments_near(kBesideTheSegment, 50), SizeIs(1));
  EXPECT_THAT(*source->tiles(map_.version(), "s1", "tracklets", {30, 90}), SizeIs(4));
  EXPECT_THAT(requests(is_any), Each(Not(HasSubstr("index.json"))));
  EXPECT_THAT(requests(is_query), SizeIs(1));
}

TEST_F(StaticStoreTest, AServerInItsPlaceIsNoticed) {
  const auto source = open_source();
  EXPECT_THAT(*source->segments_near(kBesideTheSegment, 50), SizeIs(1));
  is_static_ = false;
  now_s_ += 60;
  EXPECT_THAT(*source->segments_near(kBesideTheSegment, 50), SizeIs(1));
  EXPECT_THAT(*source->tiles(map_.version(), "s1", "tracklets", {30, 90}), SizeIs(4));
  EXPECT_THAT(requests(is_query), SizeIs(1));
}

TEST_F(StaticStoreTest, ASegmentThatTheBuildDoesNotHaveIsNotNear) {
  segments_ = {placed("s1", 0), placed("no-such", 0)};
  EXPECT_THAT(*open_source()->segments_near(kBesideTheSegment, 50), SizeIs(1));
}

TEST_F(StaticStoreTest, WhereNoDocumentIsSoundTheReasonIsTheError) {
  spoilt_ = "/segments/s1/";
  const auto near = open_source()->segments_near(kBesideTheSegment, 50);
  ASSERT_FALSE(near.ok());
  EXPECT_EQ(near.error().code, ErrorCode::corrupt);
  EXPECT_THAT(near.error().line(), HasSubstr("/segments/s1/index.json"));
}

TEST_F(StaticStoreTest, AWrongListIsNone) {
  for (const json& wrong : {json{1}, json{json::object()}, json{placed("s 1", 0)},
                            json{placed("s1", 90)}, json("segments")}) {
    segments_ = wrong;
    const auto near = open_source()->segments_near(kBesideTheSegment, 50);
    ASSERT_FALSE(near.ok()) << wrong;
    EXPECT_EQ(near.error().code, ErrorCode::unavailable);
  }
}

TEST(StaticStoreDocumentTest, OnlyTrueIsStatic) {
  EXPECT_TRUE(is_of_static_store(R"({"maps":[],"static":true})"));
  for (const char* text : {"", "[true]", "{}", R"({"static":false})", R"({"static":1})",
                           R"({"static":"true"})", R"({"maps":{"static":true}})"}) {
    EXPECT_FALSE(is_of_static_store(text)) << text;
  }
}

}  // namespace
}  // namespace milepost::testing
