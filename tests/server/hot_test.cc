// What the server keeps in memory.
#include <gtest/gtest.h>

#include "server/hot/frames_of.h"
#include "server/hot/hot_answers.h"
#include "server/hot/lru_cache.h"
#include "server/routes/handle.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using Text = std::shared_ptr<const std::string>;
using TextCache = LruCache<Text>;

Text text(const char* value) { return std::make_shared<const std::string>(value); }

TEST(LruCacheTest, LongestUnusedLeavesFirst) {
  TextCache cache(3000);  // two of a thousand bytes, with what an entry takes
  cache.add("a", text("A"), 1000);
  cache.add("b", text("B"), 1000);
  EXPECT_EQ(*cache.find("a"), "A");
  cache.add("c", text("C"), 1000);
  ASSERT_NE(cache.find("a"), nullptr);
  EXPECT_EQ(cache.find("b"), nullptr);
  EXPECT_EQ(*cache.find("c"), "C");
  EXPECT_LE(cache.bytes(), 3000U);
}

TEST(LruCacheTest, ReplacesAndClears) {
  TextCache cache(10'000);
  cache.add("a", text("A"), 1000);
  const std::size_t bytes = cache.bytes();
  cache.add("a", text("B"), 1000);
  EXPECT_EQ(cache.bytes(), bytes);
  EXPECT_EQ(*cache.find("a"), "B");
  cache.add("big", text("C"), 5000);  // more than half
  EXPECT_EQ(cache.find("big"), nullptr);
  cache.clear();
  EXPECT_EQ(cache.find("a"), nullptr);
  EXPECT_EQ(cache.bytes(), 0U);
}

class HotTest : public ::testing::Test {
 protected:
  Response answer(const std::string& target) const {
    return handle({"GET", target, {}}, *catalog_);
  }
  std::string tile_path(int index) const {
    return "/v1/maps/town/builds/" + town_.build + "/segments/s1/tiles/tracklets/" +
           std::to_string(index);
  }

  TemporaryFolder folder_;
  TownMap town_ = write_town(folder_.path() / "town.map", 100'000);
  std::shared_ptr<const Catalog> catalog_ = open_catalog(folder_.path());
};

TEST_F(HotTest, FramesAreReadOnceAndAheadWithinABound) {
  HotFrames memory(10'000'000);
  const Response range = answer("/v1/maps/town/builds/" + town_.build +
                                "/segments/s1/tiles?layer=tracklets&from_m=0&to_m=inf");
  ASSERT_EQ(frame_count(range), 4U);
  const auto first = read_frames(range, *map_of(range), 0, memory);
  ASSERT_TRUE(first.ok());
  ASSERT_EQ(first->size(), 2U);  // 200 kB; the bound is 128 kB
  EXPECT_EQ(*first->at(1), town_.frames[1]);
  EXPECT_EQ(memory.find(frame_digest(range, 1)), first->at(1));
  EXPECT_EQ(memory.find(frame_digest(range, 2)), nullptr);
  EXPECT_EQ(read_frames(range, *map_of(range), 1, memory)->at(0), first->at(1));
}

TEST(HotFramesTest, WhatIsTooBigIsSharedWhileSomebodyHoldsIt) {
  HotFrames memory(80'000);  // 10 kB in each part
  const auto big = [] { return std::make_shared<const Bytes>(6000, std::uint8_t{1}); };
  Frame first = memory.add("a", big());
  EXPECT_EQ(memory.find("a"), first);
  EXPECT_EQ(memory.add("a", big()), first);
  first.reset();
  EXPECT_EQ(memory.find("a"), nullptr);
  for (int i = 0; i < 10'000; ++i) memory.add(std::to_string(i), big());
  EXPECT_EQ(memory.find("9999"), nullptr);
}

TEST_F(HotTest, AnswersAreThoseOfOneCatalog) {
  HotAnswers answers(1'000'000);
  const auto tile = prepared(answer(tile_path(1)));
  EXPECT_EQ(answers.find("/t", catalog_), nullptr);
  answers.add("/t", catalog_, tile);
  EXPECT_EQ(answers.find("/t", catalog_), tile);
  const auto next = open_catalog(folder_.path());
  answers.add("/u", next, tile);  // not the catalog of the last find()
  EXPECT_EQ(answers.find("/u", catalog_), nullptr);
  EXPECT_EQ(answers.find("/t", next), nullptr);
  EXPECT_EQ(answers.find("/t", catalog_), nullptr);
}

TEST_F(HotTest, OnlyWhatHasATagIsKept) {
  HotAnswers answers(1'000'000);
  for (const std::string& target : {std::string("/healthz"), std::string("/v1/maps/none")}) {
    EXPECT_EQ(answers.find(target, catalog_), nullptr);
    answers.add(target, catalog_, prepared(answer(target)));
    EXPECT_EQ(answers.find(target, catalog_), nullptr);
  }
}

TEST_F(HotTest, AnAnswerKeepsNoMapInMemory) {
  const auto tile = prepared(answer(tile_path(1)));
  EXPECT_NE(tile->map.lock(), nullptr);
  catalog_.reset();
  EXPECT_EQ(tile->map.lock(), nullptr);
}

TEST_F(HotTest, PreparedAnswerKnowsIts304) {
  const auto tile = prepared(answer(tile_path(1)));
  const std::string tag(tile->response.header("ETag"));
  EXPECT_EQ(unless_known(tile, ""), tile);
  EXPECT_EQ(unless_known(tile, "\"x\""), tile);
  const auto unchanged = unless_known(tile, "\"x\", W/" + tag);
  EXPECT_EQ(unchanged->response.status, 304U);
  EXPECT_EQ(unchanged->head.find("Content-Length"), std::string::npos);
  EXPECT_NE(tile->head.find("Content-Length: 100001\r\n"), std::string::npos);
  EXPECT_EQ(unless_known(prepared(answer("/healthz")), "*")->response.status, 200U);
}

}  // namespace
}  // namespace milepost::server
