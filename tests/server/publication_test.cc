#include "server/publish/publication.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "schema/base/digest.h"
#include "schema/base/file.h"
#include "server/publish/published_headers.h"
#include "server/publish/static_tree.h"
#include "server/routes/handle.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

class PublicationTest : public ::testing::Test {
 protected:
  Result<PublishCounts> publish_now(bool remove_old = false) {
    return publish(*open_catalog(maps_.path()),
                   {tree_, remove_old, [](const std::string&) {},
                    [this] { return files_until_stop_ >= 0 && files_until_stop_-- == 0; }});
  }
  std::string content(const std::string& path) const {
    const auto text = read_text_file(tree_ / path);
    EXPECT_TRUE(text.ok()) << path;
    return text ? *text : "";
  }
  std::string root() const { return "v1/maps/town/builds/" + town_.build; }

  TemporaryFolder maps_;
  TemporaryFolder other_;
  TownMap town_ = write_town(maps_.path() / "town.map");
  fs::path tree_ = other_.path() / "tree";
  int files_until_stop_ = -1;  // never
};

TEST_F(PublicationTest, TilesCellsAndDocumentsAreThoseOfTheMap) {
  const auto counts = publish_now();
  ASSERT_TRUE(counts.ok()) << counts.error().line();
  for (std::size_t i = 0; i < town_.frames.size(); ++i) {
    EXPECT_EQ(content(root() + "/segments/s1/tiles/tracklets/" + std::to_string(i)),
              as_text(town_.frames[i]));
  }
  for (std::size_t i = 0; i < town_.cells.size(); ++i) {
    EXPECT_EQ(content(root() + "/areas/walls/" + std::to_string(kTownCells[i])),
              as_text(town_.cells[i]));
  }
  EXPECT_EQ(digest_of(as_bytes(content(root() + "/manifest"))), town_.build);
  EXPECT_FALSE(fs::exists(tree_ / root() / "manifest.sig"));
  // 4 tiles, 3 cells, 2 segments, areas, map, manifest, and the current state.
  EXPECT_EQ(counts->files, 12U + 4U);
  EXPECT_EQ(counts->written, counts->files);
}

TEST_F(PublicationTest, TheRecordOfTheMappingIsThereWhereTheManifestListsIt) {
  const LaneMap lane = write_lane(maps_.path() / "lane.map");
  ASSERT_TRUE(publish_now().ok());
  EXPECT_EQ(content("v1/maps/lane/builds/" + lane.build + "/mapping"),
            mapping_document(lane.mapping));
  EXPECT_FALSE(fs::exists(tree_ / root() / "mapping"));
}

TEST_F(PublicationTest, TheListsSayThatTheyAreStatic) {
  ASSERT_TRUE(publish_now().ok());
  const auto catalog = open_catalog(maps_.path());
  json maps = json_of(handle({"GET", "/v1/maps", ""}, *catalog));
  maps["static"] = true;
  EXPECT_EQ(json::parse(content("v1/maps/index.json")), maps);
  const json segments = json::parse(content("v1/segments"));
  EXPECT_EQ(segments.at("static"), true);
  ASSERT_EQ(segments.at("segments").size(), 2U);
  const json& first = segments["segments"][0];
  EXPECT_EQ(first.at("map"), "town");
  EXPECT_EQ(first.at("build"), town_.build);
  EXPECT_EQ(first.at("segment"), "s1");
  EXPECT_EQ(first.at("bounds"),
            json({{"west_deg", 8}, {"south_deg", 49}, {"east_deg", 8}, {"north_deg", 49.0018}}));
}

TEST_F(PublicationTest, StoppedAtAnyFileOfABuildItHasNoListThatPointsToIt) {
  constexpr int kFiles = 4 + 3 + 3;  // tiles, cells; signature, map and manifest
  for (int files = 0; files < kFiles; ++files) {
    files_until_stop_ = files;
    const auto stopped = publish_now();
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
    EXPECT_FALSE(fs::exists(tree_ / "v1/segments"));
    EXPECT_FALSE(fs::exists(tree_ / "v1/maps/index.json"));
    EXPECT_FALSE(fs::exists(tree_ / "v1/maps/town/index.json"));
    EXPECT_FALSE(fs::exists(tree_ / ".partial"));
  }
  EXPECT_TRUE(publish_now().ok());
}

TEST_F(PublicationTest, OneProcessAtATime) {
  ASSERT_TRUE(publish_now().ok());
  const auto held = StaticTree::open(tree_, "");
  ASSERT_TRUE(held.ok());
  const auto second = publish_now();
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().code, ErrorCode::unavailable);
  EXPECT_THAT(second.error().line(), HasSubstr("another process"));
}

TEST_F(PublicationTest, WhatAKilledRunLeavesIsNoForeignFile) {
  fs::create_directory(tree_);
  ASSERT_TRUE(write_text_file(tree_ / ".partial", "half a fi").ok());
  EXPECT_TRUE(publish_now().ok());
  EXPECT_FALSE(fs::exists(tree_ / ".partial"));
}

TEST_F(PublicationTest, AMapThatIsGoneIsRemovedOnlyOnRequest) {
  write_town(maps_.path() / "village.map", 100, 2);
  ASSERT_TRUE(publish_now().ok());
  fs::remove(maps_.path() / "village.map");
  EXPECT_EQ(publish_now()->removed, 0U);
  EXPECT_TRUE(fs::exists(tree_ / "v1/maps/village/index.json"));
  EXPECT_EQ(publish_now(true)->removed, 1U);
  EXPECT_FALSE(fs::exists(tree_ / "v1/maps/village"));
  EXPECT_TRUE(fs::exists(tree_ / root() / "manifest"));
}

TEST(PublishedHeadersTest, AreReadAgain) {
  const EntityTags files = {{"v1/maps/index.json", "00"}, {"v1/segments", "01"}};
  EXPECT_EQ(*entity_tags_in(headers_document(files)), files);
  for (const char* wrong :
       {"", "[]", "{}", R"({"ETag": []})", R"({"ETag": {"a": 1}})", R"({"ETag": {"a": "\""}})"}) {
    EXPECT_FALSE(entity_tags_in(wrong).ok()) << wrong;
  }
}

}  // namespace
}  // namespace milepost::server
