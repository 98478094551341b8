#include "server/routes/handle.h"

#include <gmock/gmock.h>

#include <fstream>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "schema/base/digest.h"
#include "schema/document/signature.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class HandleTest : public ::testing::Test {
 protected:
  HandleTest() : town_(write_town(folder_.path() / "town.map")) {
    catalog_ = open_catalog(folder_.path());
  }

  Response get(const std::string& target, const std::string& if_none_match = "") const {
    return handle({"GET", target, if_none_match}, *catalog_);
  }

  std::string build_path() const { return "/v1/maps/town/builds/" + town_.build; }
  std::string segment_path() const { return build_path() + "/segments/s1"; }
  std::string range_path(const std::string& from_m, const std::string& to_m) const {
    return segment_path() + "/tiles?layer=tracklets&from_m=" + from_m + "&to_m=" + to_m;
  }

  // The indices of the tiles of a range response.
  std::vector<std::uint32_t> tiles(const std::string& from_m, const std::string& to_m) const {
    const Response response = get(range_path(from_m, to_m));
    EXPECT_EQ(response.status, 200U);
    std::vector<std::uint32_t> indices;
    for (const TileEntry* tile : std::get<TileList>(response.body).tiles) {
      indices.push_back(tile->index);
    }
    return indices;
  }

  TemporaryFolder folder_;
  TownMap town_;
  std::shared_ptr<const Catalog> catalog_;
};

TEST_F(HandleTest, CatalogNamesEveryMapWithItsBuild) {
  const TownMap village = write_town(folder_.path() / "a.village.map", 10, 2);
  catalog_ = open_catalog(folder_.path());
  const Response response = get("/v1/maps");
  EXPECT_EQ(response.status, 200U);
  EXPECT_EQ(response.header("Cache-Control"), "no-cache");
  EXPECT_EQ(json_of(response), json({{"maps",
                                      {{{"name", "a.village"}, {"build", village.build}},
                                       {{"name", "town"}, {"build", town_.build}}}}}));
}

TEST_F(HandleTest, EmptyDirectoryIsAnEmptyCatalog) {
  const TemporaryFolder empty;
  catalog_ = open_catalog(empty.path());
  EXPECT_EQ(text_of(get("/v1/maps")), R"({"maps":[]})");
  EXPECT_EQ(text_of(get("/v1/segments?near=49,8&radius_m=100")), R"({"segments":[]})");
}

TEST_F(HandleTest, MapDocumentHasLayersParametersBoundsAndSegments) {
  const json map = json_of(get("/v1/maps/town"));
  EXPECT_EQ(map.at("name"), "town");
  EXPECT_EQ(map.at("build"), town_.build);
  EXPECT_EQ(map.at("layers"), json({"tracklets", "walls"}));
  EXPECT_EQ(map.at("layer_parameters").at("tracklets"), json({{"tile_m", 50}}));
  EXPECT_EQ(map.at("layer_parameters").at("walls"), json::object());
  EXPECT_EQ(map.at("feature"), json({{"extractor", "sift"}, {"contrast", 0.04}}));
  EXPECT_EQ(map.at("bounds").at("west_deg"), 8);
  EXPECT_EQ(map.at("bounds").at("south_deg"), 49);
  EXPECT_EQ(map.at("bounds").at("east_deg"), 8.01);  // of the cells
  EXPECT_EQ(map.at("bounds").at("north_deg"), 49.01);
  EXPECT_EQ(map.at("segments"), json({"s1", "s2"}));
  EXPECT_NEAR(map.at("length_m").get<double>(), 397.3, 1);
}

// From the build to every tile: each document gives the digests of what it leads to.
TEST_F(HandleTest, TheBuildCoversEveryDocumentAndTile) {
  const std::string root = "/v1/maps/town/builds/" + town_.build;
  const Response manifest = get(root + "/manifest");
  EXPECT_EQ(manifest.header("Cache-Control"), kImmutable);
  EXPECT_EQ(digest_of(as_bytes(text_of(manifest))), town_.build);
  const json listed = json_of(manifest);
  EXPECT_EQ(listed.at("format"), 3);
  const auto expect_listed = [&](const json& entry, const std::string& target) {
    const std::string text = text_of(get(root + target));
    EXPECT_EQ(entry.at("digest"), digest_of(as_bytes(text))) << target;
    EXPECT_EQ(entry.at("bytes"), text.size()) << target;
  };
  expect_listed(listed.at("map"), "/map");
  expect_listed(listed.at("areas"), "/areas");
  ASSERT_EQ(listed.at("segments").size(), 2U);
  for (const json& entry : listed.at("segments")) {
    expect_listed(entry, "/segments/" + entry.at("segment").get<std::string>());
  }
}

TEST_F(HandleTest, TheMapDocumentOfABuildNamesNeitherTheMapNorTheBuild) {
  const Response response = get("/v1/maps/town/builds/" + town_.build + "/map");
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  json expected = json_of(get("/v1/maps/town"));
  for (const char* key : {"name", "build", "segments"}) expected.erase(key);
  EXPECT_EQ(json_of(response), expected);
}

TEST_F(HandleTest, NoBuildIsSignedYet) {
  EXPECT_EQ(get("/v1/maps/town/builds/" + town_.build + "/manifest.sig").status, 404U);
}

TEST_F(HandleTest, SegmentDocumentHasLineSuccessorsAndTileIndex) {
  const Response response = get(segment_path());
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(response.header("ETag"), '"' + digest_of(as_bytes(text_of(response))) + '"');
  const json segment = json_of(response);
  EXPECT_EQ(segment.at("segment"), "s1");
  EXPECT_EQ(segment.at("successors"),
            json({{{"segment", "s2"}}, {{"segment", "far"}, {"map", "village"}}}));
  EXPECT_FALSE(segment.at("tiles").contains("walls"));
  EXPECT_EQ(segment.at("tiles").at("tracklets").at(1),
            json({{"index", 1},
                  {"from_m", 50.0},
                  {"to_m", 110.0},
                  {"items", 11},
                  {"bytes", 1001},
                  {"digest", digest_of(town_.frames[1])}}));
}

TEST_F(HandleTest, SegmentLineKeepsEveryBit) {
  const json segment = json_of(get(segment_path()));
  const Result<MapReader> reader = MapReader::open(folder_.path() / "town.map");
  ASSERT_TRUE(reader.ok());
  const Result<StoredSegment> stored = reader->segment("s1");
  ASSERT_EQ(segment.at("line").size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const StoredVertex& vertex = stored->vertices[i];
    EXPECT_EQ(segment.at("line").at(i),
              json({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m, vertex.along_m}));
  }
  EXPECT_EQ(segment.at("length_m"), stored->length_m);
}

TEST_F(HandleTest, RangeHoldsEveryTileThatMeetsIt) {
  EXPECT_THAT(tiles("0", "200"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(tiles("70", "90"), ElementsAre(1));
  EXPECT_THAT(tiles("55", "55"), ElementsAre(0, 1));
  EXPECT_THAT(tiles("-100", "-0.001"), IsEmpty());
  EXPECT_THAT(tiles("-100", "0"), ElementsAre(0));
  EXPECT_THAT(tiles("160", "1e6"), ElementsAre(2, 3));
  EXPECT_THAT(tiles("200", "inf"), ElementsAre(3));
  EXPECT_THAT(tiles("200.001", "inf"), IsEmpty());
  EXPECT_THAT(tiles("160.001", "170"), ElementsAre(3));
}

TEST_F(HandleTest, RangeAnswersWhatTheStoreAnswers) {
  const Result<MapReader> reader = MapReader::open(folder_.path() / "town.map");
  ASSERT_TRUE(reader.ok());
  for (double from_m = -10; from_m < 220; from_m += 5) {
    const double to_m = from_m + 17;
    const auto stored = reader->tiles_in("s1", "tracklets", {from_m, to_m});
    ASSERT_TRUE(stored.ok());
    std::vector<std::uint32_t> indices;
    for (const TileEntry& tile : *stored) indices.push_back(tile.index);
    EXPECT_EQ(tiles(std::to_string(from_m), std::to_string(to_m)), indices) << from_m;
  }
}

TEST_F(HandleTest, RangeKnowsItsLengthAndTagBeforeReading) {
  const Response response = get(range_path("70", "130"));
  EXPECT_EQ(response.header("Content-Type"), "application/octet-stream");
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(response.content_length(), 1001U + 1002U);
  EXPECT_NE(response.header("ETag"), "");
  EXPECT_EQ(response.header("ETag"), get(range_path("71", "130")).header("ETag"));
  EXPECT_NE(response.header("ETag"), get(range_path("70", "90")).header("ETag"));
}

TEST_F(HandleTest, RangeWithoutTilesIsAnEmptyAnswer) {
  const Response response = get(range_path("500", "600"));
  EXPECT_EQ(response.status, 200U);
  EXPECT_EQ(response.content_length(), 0U);
  EXPECT_EQ(get(segment_path() + "/tiles?layer=walls&from_m=0&to_m=9").content_length(), 0U);
}

TEST_F(HandleTest, WrongRangesAreToldApart) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"layer=tracklets&from_m=20&to_m=10", "from_m is greater than to_m"},
      {"layer=tracklets&from_m=-inf&to_m=10", "parameter from_m: is not finite"},
      {"layer=tracklets&from_m=inf&to_m=inf", "parameter from_m: is not finite"},
      {"layer=tracklets&from_m=nan&to_m=10", "parameter from_m: is 'nan'"},
      {"layer=tracklets&from_m=0&to_m=NaN", "parameter to_m: is 'NaN'"},
      {"layer=tracklets&from_m=0&to_m=-inf", "from_m is greater than to_m"},
      {"layer=tracklets&from_m=0", "parameter to_m: is missing"},
      {"layer=tracklets&to_m=0", "parameter from_m: is missing"},
      {"from_m=0&to_m=0", "parameter layer: is missing"},
      {"layer=tracklets&from_m=&to_m=0", "parameter from_m: is ''"},
      {"layer=tracklets&from_m=1m&to_m=2", "parameter from_m: is '1m'"},
      {"layer=tracklets&from_m=0&to_m=1e999", "parameter to_m: is '1e999'"},
      {"layer=tracklets&from_m=0&from_m=0&to_m=1", "parameter from_m: is given more than once"},
      {"layer=tracklets&from_m=0&to_m=1&x=2", "parameter 'x': is unknown"},
      {"layer=a%2Fb&from_m=0&to_m=1", "layer 'a/b': is not a valid name"},
  };
  for (const auto& [query, detail] : cases) {
    const Response response = get(segment_path() + "/tiles?" + query);
    EXPECT_EQ(problem_status(response), 400U) << query;
    EXPECT_THAT(detail_of(response), HasSubstr(detail)) << query;
  }
}

TEST_F(HandleTest, TileHasItsDigestAsTag) {
  const Response response = get(segment_path() + "/tiles/tracklets/2");
  EXPECT_EQ(response.status, 200U);
  EXPECT_EQ(response.header("ETag"), '"' + digest_of(town_.frames[2]) + '"');
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(response.content_length(), 1002U);
}

TEST_F(HandleTest, AbsentThingsAre404) {
  const std::string other(32, '0');
  for (const std::string& target :
       {std::string("/viewer"), std::string("/v1"), std::string("/v1/maps/"),
        std::string("/nothing"), std::string("/v1/maps/nowhere"),
        "/v1/maps/nowhere/builds/" + other + "/segments/s1", build_path() + "/segments/s3",
        segment_path() + "/tiles/glance/0", segment_path() + "/tiles?layer=glance&from_m=0&to_m=1",
        segment_path() + "/tiles/tracklets/4", segment_path() + "/tiles/walls/0", build_path(),
        segment_path() + "/", segment_path() + "/tiles/tracklets/0/",
        build_path() + "/segments/"}) {
    EXPECT_EQ(problem_status(get(target)), 404U) << target;
  }
}

TEST_F(HandleTest, AnotherBuildIs410AndNamesTheCurrentOne) {
  const std::string other(32, '0');
  for (const char* rest : {"/segments/s1", "/segments/s1/tiles?layer=tracklets&from_m=0&to_m=1",
                           "/segments/s1/tiles/tracklets/0", "/segments/never"}) {
    const Response response = get("/v1/maps/town/builds/" + other + rest);
    EXPECT_EQ(problem_status(response), 410U) << rest;
    EXPECT_THAT(detail_of(response), HasSubstr(town_.build));
  }
}

TEST_F(HandleTest, MalformedPathsAre400) {
  for (const std::string& target : {std::string("/v1/maps/town/builds/latest/segments/s1"),
                                    "/v1/maps/town/builds/" + std::string(32, 'A') + "/segments/s1",
                                    std::string("/v1/maps/.x"),
                                    std::string("/v1/maps/a%20b"),
                                    std::string("/v1/maps/a%2Fb"),
                                    std::string("/v1/maps/%"),
                                    std::string("/v1/maps/%4"),
                                    std::string("/v1/maps/%zz"),
                                    std::string("/v1/maps/%+1"),
                                    std::string("/v1/maps/a%00"),
                                    std::string("/v1/maps/a%7f"),
                                    std::string("/v1/maps/.."),
                                    std::string("/v1/%2e%2E/v1/maps"),
                                    std::string("/v1/./maps"),
                                    std::string("v1/maps"),
                                    std::string("*"),
                                    std::string(""),
                                    std::string("/v1/maps/") + std::string(65, 'a'),
                                    std::string("/v1/maps/%ff"),
                                    segment_path() + "/tiles/tracklets/07",
                                    segment_path() + "/tiles/tracklets/-1",
                                    segment_path() + "/tiles/tracklets/+1",
                                    segment_path() + "/tiles/tracklets/1x",
                                    segment_path() + "/tiles/tracklets/4294967296"}) {
    EXPECT_EQ(problem_status(get(target)), 400U) << target;
  }
}

TEST_F(HandleTest, EncodedAndAbsoluteFormsNameTheSameThing) {
  EXPECT_EQ(text_of(get("/v1/maps/%74own")), text_of(get("/v1/maps/town")));
  EXPECT_EQ(text_of(get("http://host:80/v1/maps?")), text_of(get("/v1/maps")));
  EXPECT_EQ(get(segment_path() + "/tiles?l%61yer=tracklets&from_m=0&to_m=%39").status, 200U);
}

TEST_F(HandleTest, NearSegmentsComeNearestFirst) {
  // 30 m along s1 and 7.3 m east of it: 30 m north of s2.
  const Response response = get("/v1/segments?near=49.00027,8.0001&radius_m=100");
  EXPECT_EQ(response.header("Cache-Control"), "no-cache");
  const json segments = json_of(response).at("segments");
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments.at(0).at("map"), "town");
  EXPECT_EQ(segments.at(0).at("build"), town_.build);
  EXPECT_EQ(segments.at(0).at("segment"), "s1");
  EXPECT_NEAR(segments.at(0).at("along_m").get<double>(), 30.03, 0.01);
  EXPECT_NEAR(segments.at(0).at("distance_m").get<double>(), 7.31, 0.01);
  EXPECT_NEAR(segments.at(0).at("length_m").get<double>(), 200.2, 0.1);
  EXPECT_EQ(segments.at(1).at("segment"), "s2");
  EXPECT_NEAR(segments.at(1).at("distance_m").get<double>(), 30.03, 0.01);
  EXPECT_EQ(json_of(get("/v1/segments?near=49.00027,8.0001&radius_m=20")).at("segments").size(),
            1U);
  EXPECT_EQ(json_of(get("/v1/segments?near=49.00027,8.0001&radius_m=7")).at("segments").size(), 0U);
  EXPECT_EQ(json_of(get("/v1/segments?near=-49%2C8&radius_m=10000")).at("segments").size(), 0U);
}

TEST_F(HandleTest, OrderOfNearSegmentsIsThatOfTheirDistance) {
  const json segments =
      json_of(get("/v1/segments?near=49.00005,8.001&radius_m=100")).at("segments");
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments.at(0).at("segment"), "s2");
  EXPECT_EQ(segments.at(1).at("segment"), "s1");
}

TEST_F(HandleTest, WrongNearQueriesAreToldApart) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"radius_m=10", "parameter near: is missing"},
      {"near=49,8", "parameter radius_m: is missing"},
      {"near=49&radius_m=10", "parameter near: is '49'"},
      {"near=49,8,110&radius_m=10", "longitude of near: is '8,110'"},
      {"near=nan,8&radius_m=10", "latitude of near: is 'nan'"},
      {"near=x,8&radius_m=10", "latitude of near: is 'x'"},
      {"near=90.1,8&radius_m=10", "parameter near: is out of range"},
      {"near=49,180.1&radius_m=10", "parameter near: is out of range"},
      {"near=inf,8&radius_m=10", "parameter near: is out of range"},
      {"near=49,8&radius_m=0", "parameter radius_m: is out of range"},
      {"near=49,8&radius_m=-1", "parameter radius_m: is out of range"},
      {"near=49,8&radius_m=10000.1", "parameter radius_m: is out of range"},
      {"near=49,8&radius_m=inf", "parameter radius_m: is out of range"},
      {"near=49,8&radius_m=nan", "parameter radius_m: is 'nan'"},
      {"near=49,8&near=49,8&radius_m=10", "parameter near: is given more than once"},
      {"near=49,8&radius_m=10&limit=1", "parameter 'limit': is unknown here; known are near"},
      {"near=49,8&radius_m=10&", "parameter '': is unknown"},
      {"near=49,8&radius_m=%3", "'%3' is not a percent-encoding"},
      {"near=49,8&radius_m=1%0a", "parameter radius_m: holds a control byte"},
  };
  for (const auto& [query, detail] : cases) {
    const Response response = get("/v1/segments?" + query);
    EXPECT_EQ(problem_status(response), 400U) << query;
    EXPECT_THAT(detail_of(response), HasSubstr(detail)) << query;
  }
  EXPECT_EQ(problem_status(get("/v1/maps?x=1")), 400U);
}

TEST_F(HandleTest, KnownTagIs304WithoutBody) {
  for (const std::string& target :
       {std::string("/v1/maps"), std::string("/v1/maps/town"), std::string("/openapi.yaml"),
        std::string("/v1/segments?near=49,8&radius_m=10"), segment_path(),
        segment_path() + "/tiles/tracklets/2", range_path("0", "100"), range_path("900", "1000")}) {
    const Response fresh = get(target);
    ASSERT_EQ(fresh.status, 200U) << target;
    const std::string tag(fresh.header("ETag"));
    for (const std::string& field :
         {tag, "W/" + tag, "\"other\", " + tag, tag + ",\"other\"", std::string("*")}) {
      const Response known = get(target, field);
      EXPECT_EQ(known.status, 304U) << target << ' ' << field;
      EXPECT_EQ(known.content_length(), 0U);
      EXPECT_EQ(known.header("ETag"), tag);
      EXPECT_EQ(known.header("Cache-Control"), fresh.header("Cache-Control"));
    }
    for (const std::string& field :
         {std::string("\"other\""), tag.substr(1, 32), std::string(",")}) {
      EXPECT_EQ(get(target, field).status, 200U) << target << ' ' << field;
    }
  }
  EXPECT_EQ(get("/v1/maps/nowhere", "*").status, 404U);
}

TEST_F(HandleTest, OtherMethodsAre405WithAllow) {
  for (const char* method : {"POST", "PUT", "DELETE", "CONNECT", "BREW"}) {
    const Response response = handle({method, "/v1/maps", ""}, *catalog_);
    EXPECT_EQ(problem_status(response), 405U) << method;
    EXPECT_EQ(response.header("Allow"), "GET, HEAD, OPTIONS");
  }
  EXPECT_EQ(handle({"POST", "/nothing", ""}, *catalog_).status, 404U);
  EXPECT_EQ(handle({"HEAD", "/v1/maps", ""}, *catalog_).status, 200U);
}

TEST_F(HandleTest, LongAddressIs414) {
  EXPECT_EQ(problem_status(get("/v1/maps/" + std::string(kMaxTargetBytes, 'a'))), 414U);
}

TEST_F(HandleTest, ServiceAddressesAnswerInText) {
  for (const char* target : {"/healthz", "/readyz"}) {
    EXPECT_EQ(text_of(get(target)), "ok\n");
    EXPECT_EQ(get(target).header("Content-Type"), "text/plain; charset=utf-8");
  }
}

std::string openapi_text() {
  std::ifstream file(MILEPOST_OPENAPI_YAML);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The keys below "paths:": lines with two blanks, a path and a colon.
std::set<std::string> openapi_paths() {
  std::istringstream text(openapi_text());
  std::set<std::string> paths;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("  /")) paths.insert(line.substr(2, line.size() - 3));
  }
  return paths;
}

TEST_F(HandleTest, OpenapiIsServedAsItIsInTheSource) {
  EXPECT_EQ(text_of(get("/openapi.yaml")), openapi_text());
  EXPECT_EQ(get("/openapi.yaml").header("Content-Type"), "application/yaml");
}

TEST_F(HandleTest, OpenapiAndTheServerKnowTheSamePaths) {
  const auto patterns = path_patterns();
  EXPECT_EQ(openapi_paths(), std::set<std::string>(patterns.begin(), patterns.end()));
}

TEST_F(HandleTest, EveryPathOfOpenapiIsAnswered) {
  const std::string lane = write_lane(folder_.path() / "lane.map").build;
  const std::vector<std::pair<std::string, std::string>> values = {
      {"{map}", "lane"},
      {"{build}", lane},
      {"{release}", Viewer::plain().release()},
      {"{file}", "app.js"},
      {"{segment}", "s1"},
      {"tiles/{layer}", "tiles/tracklets"},
      {"areas/{layer}", "areas/walls"},
      {"{index}", "0"},
      {"{cell}", std::to_string(kTownCells[0])}};
  catalog_ = open_catalog(folder_.path());
  ASSERT_FALSE(openapi_paths().empty());
  std::ofstream(folder_.path() / "lane.map.sig")
      << signature_text({"lane", lane, 1796000000}, SecretKey(SecretKey::Seed{1}));
  for (std::string path : openapi_paths()) {
    for (const auto& [name, value] : values) {
      const std::size_t at = path.find(name);
      if (at != std::string::npos) path.replace(at, name.size(), value);
    }
    if (path.ends_with("/walls")) path += "?bbox=8,49,9,50";
    if (path.ends_with("/tiles")) path += "?layer=tracklets&from_m=0&to_m=1";
    if (path == "/v1/segments") path += "?near=49,8&radius_m=1";
    if (path.ends_with("/changes")) path += "?from=" + lane;
    EXPECT_EQ(get(path).status, 200U) << path;
  }
}

}  // namespace
}  // namespace milepost::server
