#include "client/fetch/documents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/client/fetch/fake_map.h"

namespace milepost::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Change = std::function<void(json&)>;
using Changes = std::vector<std::pair<std::string, Change>>;

constexpr char kWhere[] = "http://here/document";

void expect_corrupt(bool parsed, const Error& error) {
  ASSERT_FALSE(parsed);
  EXPECT_EQ(error.code, ErrorCode::corrupt);
  EXPECT_THAT(error.line(), StartsWith(std::string(kWhere) + ": "));
}

TEST(SegmentDocument, IsRead) {
  const FakeMap map;
  const auto document = parse_segment_document(map.segment_document(), kWhere, map.version(), "s1");
  ASSERT_TRUE(document.ok()) << document.error().line();
  EXPECT_EQ(document->description.id, "s1");
  EXPECT_EQ(document->description.vertices.size(), 3U);
  ASSERT_EQ(document->tiles.at("tracklets").size(), 10U);
  EXPECT_EQ(document->tiles.at("tracklets")[4], map.index[4]);
  EXPECT_EQ(document->tiles.at("tracklets")[4].along.from_m, 80);
  EXPECT_EQ(document->tiles.at("tracklets")[4].along.to_m, 105);
  EXPECT_EQ(document->tiles.at("tracklets")[4].bytes, 1040U);
}

TEST(SegmentDocument, FurtherKeysAreAllowed) {
  const FakeMap map;
  json document = json::parse(map.segment_document());
  document["news"] = {1, 2};
  document["tiles"]["tracklets"][0]["colour"] = "blue";
  EXPECT_TRUE(parse_segment_document(document.dump(), kWhere, map.version(), "s1").ok());
}

TEST(SegmentDocument, EveryWrongFieldIsRefused) {
  const FakeMap map;
  const auto first_tile = [](json& d) -> json& { return d["tiles"]["tracklets"][0]; };
  const Changes changes = {
      {"another segment", [](json& d) { d["segment"] = "s2"; }},
      {"no segment", [](json& d) { d.erase("segment"); }},
      {"length negative", [](json& d) { d["length_m"] = -1; }},
      {"length a text", [](json& d) { d["length_m"] = "200"; }},
      {"length absurd", [](json& d) { d["length_m"] = 1e300; }},
      {"no line", [](json& d) { d.erase("line"); }},
      {"line an object", [](json& d) { d["line"] = json::object(); }},
      {"vertex a number", [](json& d) { d["line"][0] = 49; }},
      {"vertex too short",
       [](json& d) {
         d["line"][0] = {49, 8};
       }},
      {"vertex of texts",
       [](json& d) {
         d["line"][0] = {"49", "8", "1"};
       }},
      {"latitude", [](json& d) { d["line"][0][0] = 91; }},
      {"longitude", [](json& d) { d["line"][0][1] = -181; }},
      {"altitude", [](json& d) { d["line"][0][2] = 1e9; }},
      {"null in a vertex", [](json& d) { d["line"][0][2] = nullptr; }},
      {"successor a number", [](json& d) { d["successors"] = {1}; }},
      {"successor without a segment", [](json& d) { d["successors"][0].erase("segment"); }},
      {"successor a path", [](json& d) { d["successors"][0]["segment"] = "../x"; }},
      {"successor's map a path", [](json& d) { d["successors"][1]["map"] = "../x"; }},
      {"successor's map empty", [](json& d) { d["successors"][1]["map"] = ""; }},
      {"no passes", [](json& d) { d.erase("passes"); }},
      {"pass without a drive", [](json& d) { d["passes"][0].erase("drive"); }},
      {"pass that descends", [](json& d) { d["passes"][0]["to_m"] = 39; }},
      {"pass before the drive", [](json& d) { d["passes"][0]["from_m"] = -1; }},
      {"sigma negative", [](json& d) { d["position_sigma_m"] = -0.1; }},
      {"sigma a text", [](json& d) { d["position_sigma_m"] = "0.1"; }},
      {"correlation absurd", [](json& d) { d["position_correlation_m"] = 1e300; }},
      {"assumed a number", [](json& d) { d["assumed"] = 1; }},
      {"no tiles", [](json& d) { d.erase("tiles"); }},
      {"tiles a list", [](json& d) { d["tiles"] = json::array(); }},
      {"layer a number", [](json& d) { d["tiles"]["tracklets"] = 1; }},
      {"layer an object",
       [](json& d) {
         d["tiles"]["tracklets"] = {{"a", 1}};
       }},
      {"layer's name a path", [](json& d) { d["tiles"]["../x"] = json::array(); }},
      {"tile a number", [&](json& d) { first_tile(d) = 1; }},
      {"index negative", [&](json& d) { first_tile(d)["index"] = -1; }},
      {"index a fraction", [&](json& d) { first_tile(d)["index"] = 0.5; }},
      {"index too large", [&](json& d) { first_tile(d)["index"] = 4294967296ULL; }},
      {"index twice", [&](json& d) { first_tile(d)["index"] = 1; }},
      {"from after to", [&](json& d) { first_tile(d)["from_m"] = 26; }},
      {"from absurd", [&](json& d) { first_tile(d)["from_m"] = -1e300; }},
      {"to a null", [&](json& d) { first_tile(d)["to_m"] = nullptr; }},
      {"items negative", [&](json& d) { first_tile(d)["items"] = -1; }},
      {"no bytes", [&](json& d) { first_tile(d)["bytes"] = 0; }},
      {"too many bytes", [&](json& d) { first_tile(d)["bytes"] = 1ULL << 40U; }},
      {"digest short", [&](json& d) { first_tile(d)["digest"] = "00"; }},
      {"digest absent", [&](json& d) { first_tile(d).erase("digest"); }},
  };
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    json document = json::parse(map.segment_document());
    change(document);
    const auto parsed = parse_segment_document(document.dump(), kWhere, map.version(), "s1");
    expect_corrupt(parsed.ok(), parsed.ok() ? Error{} : parsed.error());
  }
}

TEST(SegmentDocument, TextThatIsNoDocumentIsRefused) {
  const FakeMap map;
  const std::string good = map.segment_document();
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("7"), std::string("<html></html>"),
        good.substr(0, good.size() / 2), good + "x", std::string(1000000, '['),
        std::string("{\"map\": \"\xff\xfe\"}"), std::string("{\"length_m\": 1e999}")}) {
    SCOPED_TRACE(text.substr(0, 20));
    const auto parsed = parse_segment_document(text, kWhere, map.version(), "s1");
    expect_corrupt(parsed.ok(), parsed.ok() ? Error{} : parsed.error());
  }
}

TEST(AreasDocument, IsRead) {
  const FakeMap map;
  const auto document = parse_areas_document(map.areas_document(), kWhere);
  ASSERT_TRUE(document.ok()) << document.error().line();
  ASSERT_EQ(document->size(), 1U);
  EXPECT_EQ(document->at("walls"), map.cells);
  EXPECT_EQ(document->at("walls")[4].bytes, 540U);
  EXPECT_EQ(document->at("walls")[4].items, 10U);
}

TEST(AreasDocument, EveryWrongFieldIsRefused) {
  const FakeMap map;
  const auto first_cell = [](json& d) -> json& { return d["cells"]["walls"][0]; };
  const Changes changes = {
      {"no cells", [](json& d) { d.erase("cells"); }},
      {"cells a list", [](json& d) { d["cells"] = json::array(); }},
      {"layer an object", [](json& d) { d["cells"]["walls"] = json::object(); }},
      {"layer's name a path", [](json& d) { d["cells"]["../x"] = json::array(); }},
      {"cell a number", [&](json& d) { first_cell(d) = 1; }},
      {"number negative", [&](json& d) { first_cell(d)["cell"] = -1; }},
      {"number beyond the grid",
       [](json& d) { d["cells"]["walls"].back()["cell"] = 2592000000ULL; }},
      {"number twice", [&](json& d) { first_cell(d)["cell"] = d["cells"]["walls"][1]["cell"]; }},
      {"items negative", [&](json& d) { first_cell(d)["items"] = -1; }},
      {"no bytes", [&](json& d) { first_cell(d)["bytes"] = 0; }},
      {"digest short", [&](json& d) { first_cell(d)["digest"] = "00"; }},
  };
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    json document = json::parse(map.areas_document());
    change(document);
    const auto parsed = parse_areas_document(document.dump(), kWhere);
    expect_corrupt(parsed.ok(), parsed.ok() ? Error{} : parsed.error());
  }
}

TEST(CatalogDocument, IsRead) {
  const FakeMap map;
  const auto maps = parse_catalog_document(map.catalog_document(), kWhere);
  ASSERT_TRUE(maps.ok()) << maps.error().line();
  EXPECT_EQ(*maps, std::vector<MapVersion>{map.version()});
  EXPECT_TRUE(parse_catalog_document(R"({"maps": []})", kWhere)->empty());
}

TEST(CatalogDocument, EveryWrongFieldIsRefused) {
  for (const char* text :
       {R"({})", R"({"maps": {}})", R"({"maps": [7]})", R"({"maps": [{"name": "town"}]})",
        R"({"maps": [{"name": "town", "build": "latest"}]})",
        R"({"maps": [{"build": "00112233445566778899aabbccddeeff"}]})"}) {
    SCOPED_TRACE(text);
    const auto parsed = parse_catalog_document(text, kWhere);
    expect_corrupt(parsed.ok(), parsed.ok() ? Error{} : parsed.error());
  }
}

TEST(MapDocument, IsRead) {
  const FakeMap map;
  const auto description = parse_map_document(map.map_document(), kWhere, map.version());
  ASSERT_TRUE(description.ok()) << description.error().line();
  EXPECT_EQ(description->version, map.version());
  EXPECT_EQ(description->layers.size(), 2U);
  EXPECT_EQ(description->layers.at("tracklets")->focal_px(), 600);
  EXPECT_EQ(description->layers.at("walls").error().code, ErrorCode::corrupt);  // not needed
  EXPECT_EQ(description->bounds.west_deg, 8.4);
  EXPECT_EQ(description->bounds.south_deg, 49);
  EXPECT_EQ(description->bounds.east_deg, 8.4);
  EXPECT_EQ(description->bounds.north_deg, 49.0018);
}

TEST(MapDocument, EveryWrongFieldIsRefused) {
  const FakeMap map;
  const Changes changes = {
      {"layers absent", [](json& d) { d.erase("layers"); }},
      {"layer a number", [](json& d) { d["layers"] = {1}; }},
      {"layer without parameters", [](json& d) { d["layers"] = {"roofs"}; }},
      {"parameters a text", [](json& d) { d["layer_parameters"]["walls"] = "x"; }},
      {"feature a list", [](json& d) { d["feature"] = {1}; }},
      {"bounds absent", [](json& d) { d.erase("bounds"); }},
      {"a side absent", [](json& d) { d["bounds"].erase("east_deg"); }},
      {"west of east", [](json& d) { d["bounds"]["west_deg"] = 8.5; }},
      {"south of north", [](json& d) { d["bounds"]["north_deg"] = 48; }},
      {"beyond the pole", [](json& d) { d["bounds"]["north_deg"] = 91; }},
  };
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    json document = json::parse(map.map_document());
    change(document);
    const auto parsed = parse_map_document(document.dump(), kWhere, map.version());
    expect_corrupt(parsed.ok(), parsed.ok() ? Error{} : parsed.error());
  }
}

TEST(NearbyDocument, EveryWrongFieldIsRefused) {
  const FakeMap map;
  ASSERT_TRUE(parse_nearby_document(map.near_document(), kWhere).ok());
  EXPECT_TRUE(parse_nearby_document(R"({"segments": []})", kWhere)->empty());
  const auto first = [](json& d) -> json& { return d["segments"][0]; };
  const Changes changes = {
      {"segments absent", [](json& d) { d.erase("segments"); }},
      {"entry a number", [&](json& d) { first(d) = 1; }},
      {"map empty", [&](json& d) { first(d)["map"] = ""; }},
      {"map too long", [&](json& d) { first(d)["map"] = std::string(256, 'm'); }},
      {"build not a digest", [&](json& d) { first(d)["build"] = "b"; }},
      {"segment a path", [&](json& d) { first(d)["segment"] = "a/b"; }},
      {"along negative", [&](json& d) { first(d)["along_m"] = -0.1; }},
      {"distance negative", [&](json& d) { first(d)["distance_m"] = -0.1; }},
      {"length a null", [&](json& d) { first(d)["length_m"] = nullptr; }},
  };
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    json document = json::parse(map.near_document());
    change(document);
    const auto parsed = parse_nearby_document(document.dump(), kWhere);
    expect_corrupt(parsed.ok(), parsed.ok() ? Error{} : parsed.error());
  }
}

TEST(NearbyDocument, TheErrorNamesTheField) {
  const auto parsed = parse_nearby_document(R"({"segments": 7})", kWhere);
  ASSERT_FALSE(parsed.ok());
  EXPECT_THAT(parsed.error().line(), HasSubstr("\"segments\""));
}

}  // namespace
}  // namespace milepost::testing
