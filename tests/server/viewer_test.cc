// The routes of the viewer and of the record of a mapping, as a function of values.
#include "server/viewer/viewer.h"

#include <gmock/gmock.h>

#include "schema/base/digest.h"
#include "server/routes/handle.h"
#include "server/viewer/places.h"
#include "server/viewer/viewer_files.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class ViewerTest : public ::testing::Test {
 protected:
  ViewerTest() : lane_(write_lane(folder_.path() / "lane.map")) {
    catalog_ = open_catalog(folder_.path());
  }

  Response get(const std::string& target, const std::string& if_none_match = "") const {
    return handle({"GET", target, if_none_match}, *catalog_);
  }
  std::string build_path(const std::string& root) const {
    return root + "/maps/lane/builds/" + lane_.build;
  }
  std::string landmarks_path() const { return build_path("/viewer") + "/segments/s1/landmarks/0"; }
  std::string walls_path() const {
    return build_path("/viewer") + "/walls/" + std::to_string(lane_.walls.cell);
  }

  TemporaryFolder folder_;
  LaneMap lane_;
  std::shared_ptr<const Catalog> catalog_;
};

std::string file_path(std::string_view name) {
  return "/viewer/" + Viewer::plain().release() + '/' + std::string(name);
}

TEST_F(ViewerTest, PageMayLoadFromThisServerOnly) {
  const Response page = get("/");
  EXPECT_EQ(page.status, 200U);
  EXPECT_EQ(page.header("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(page.header("Cache-Control"), "no-cache");
  EXPECT_EQ(page.header("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(page.header("Content-Security-Policy"),
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
            "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  EXPECT_THAT(text_of(page), Not(HasSubstr("@")));
  EXPECT_EQ(get("/", std::string(page.header("ETag"))).status, 304U);
}

TEST_F(ViewerTest, PageNamesTheFilesOfItsRelease) {
  const std::string page = text_of(get("/"));
  for (const char* name : {"app.js", "style.css", "leaflet.css"}) {
    EXPECT_THAT(page, HasSubstr('"' + file_path(name) + '"'));
  }
}

TEST_F(ViewerTest, FilesNeverChangeUnderTheirUrl) {
  for (const ViewerFile& file : viewer_files()) {
    if (file.name == "index.html") continue;
    const Response response = get(file_path(file.name));
    EXPECT_EQ(text_of(response), file.text) << file.name;
    EXPECT_EQ(response.header("Cache-Control"), kImmutable);
    EXPECT_EQ(response.header("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(response.header("Content-Type"), file.name.ends_with(".css")
                                                   ? "text/css; charset=utf-8"
                                                   : "text/javascript; charset=utf-8");
    EXPECT_EQ(response.header("ETag"), '"' + digest_of(as_bytes(file.text)) + '"');
  }
  EXPECT_THAT(text_of(get(file_path("leaflet.js"))), HasSubstr("Redistributions in binary form"));
}

TEST_F(ViewerTest, OtherFilesAndReleasesAre404) {
  for (const std::string& target : {file_path("index.html"), file_path("other.js"), file_path(""),
                                    "/viewer/" + std::string(32, '0') + "/app.js",
                                    std::string("/viewer/app.js"), file_path("app.js") + "/"}) {
    EXPECT_EQ(problem_status(get(target)), 404U) << target;
  }
  EXPECT_EQ(problem_status(get("/?x=1")), 400U);
}

TEST_F(ViewerTest, TilesOfAnOperatorAreAllowedFromTheirHostOnly) {
  const Result<Viewer> viewer = Viewer::with(
      {"https://tiles.example.org:8443/a/{z}/{x}/{y}.png?k=\"><b>&", "(c) \"A\" & <B>"});
  ASSERT_TRUE(viewer.ok());
  EXPECT_THAT(viewer->policy(), HasSubstr("img-src 'self' data: https://tiles.example.org:8443;"));
  const Response page = handle({"GET", "/", ""}, *catalog_, *viewer);
  EXPECT_EQ(page.header("Content-Security-Policy"), viewer->policy());
  EXPECT_THAT(
      text_of(page),
      HasSubstr(
          R"(content="https://tiles.example.org:8443/a/{z}/{x}/{y}.png?k=&quot;>&lt;b>&amp;")"));
  EXPECT_THAT(text_of(page), HasSubstr(R"(content="(c) &quot;A&quot; &amp; &lt;B>")"));
}

TEST_F(ViewerTest, WrongTilesAreToldApart) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"tiles/{z}/{x}/{y}.png", "do not start with https://"},
      {"ftp://a/{z}/{x}/{y}", "do not start with https://"},
      {"https:///{z}/{x}/{y}", "name no host"},
      {"https://{s}.example.org/{z}/{x}/{y}", "name no host"},
      {"https://a;script-src *//{z}/{x}/{y}", "name no host"},
      {"https://a b/{z}/{x}/{y}", "name no host"},
      {"https://a/{z}/{x}.png", "lack the placeholder {y}"},
      {"https://a", "lack the placeholder {z}"},
  };
  for (const auto& [url, what] : cases) {
    const Result<Viewer> viewer = Viewer::with({url, ""});
    ASSERT_FALSE(viewer.ok()) << url;
    EXPECT_EQ(viewer.error().code, ErrorCode::invalid_input);
    EXPECT_THAT(viewer.error().line(), HasSubstr(what));
  }
}

TEST_F(ViewerTest, LandmarksAreShownWhereTheyAre) {
  const Response response = get(landmarks_path());
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  const json landmarks = json_of(response);
  EXPECT_EQ(landmarks.at("items"), 3);
  ASSERT_EQ(landmarks.at("landmarks").size(), 3U);
  const json& last = landmarks.at("landmarks").at(2);  // 2 m north of 49 N 8 E
  ASSERT_EQ(last.size(), 8U);
  EXPECT_NEAR(last.at(0).get<double>(), 49 + 2 / 111'200.0, 2e-7);
  EXPECT_NEAR(last.at(1).get<double>(), 8, 1e-7);
  EXPECT_EQ(last.at(2), 2);
  EXPECT_NEAR(last.at(3).get<double>(), 0.5, 0.02);
  EXPECT_NEAR(last.at(4).get<double>(), 1, 0.04);
  EXPECT_EQ(last.at(5), 0);
  EXPECT_EQ(last.at(6), 5);
  EXPECT_EQ(last.at(7), 2);
}

TEST_F(ViewerTest, ManyLandmarksAreThinnedEvenly) {
  lane_ = write_lane(folder_.path() / "lane.map", 3 * kMaxShownItems);
  catalog_ = open_catalog(folder_.path());
  const json landmarks = json_of(get(landmarks_path()));
  EXPECT_EQ(landmarks.at("items"), 3 * kMaxShownItems);
  ASSERT_EQ(landmarks.at("landmarks").size(), kMaxShownItems);
  EXPECT_NEAR(landmarks.at("landmarks").at(1).at(0).get<double>(), 49 + 3 / 111'200.0, 2e-7);
}

TEST_F(ViewerTest, WallsAreShownWhereTheyAre) {
  const Response response = get(walls_path());
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(json_of(response),
            json({{"items", 1}, {"walls", {{49.001, 8.001, 49.001, 8.002, 0.5}}}}));
}

TEST_F(ViewerTest, PlacesOfWhatIsAbsentOrOldAreToldApart) {
  const std::string old = "/viewer/maps/lane/builds/" + std::string(32, '0');
  for (const std::string& target :
       {build_path("/viewer") + "/segments/s2/landmarks/0",
        build_path("/viewer") + "/segments/s1/landmarks/1", build_path("/viewer") + "/walls/0",
        std::string("/viewer/maps/none/builds/") + lane_.build + "/walls/0"}) {
    EXPECT_EQ(problem_status(get(target)), 404U) << target;
  }
  EXPECT_EQ(problem_status(get(build_path("/viewer") + "/segments/s1/landmarks/00")), 400U);
  EXPECT_EQ(problem_status(get(old + "/segments/s1/landmarks/0")), 410U);
  EXPECT_EQ(problem_status(get(old + "/walls/0")), 410U);
}

TEST_F(ViewerTest, TilesThatCannotBeDecodedAre500) {
  const TownMap town = write_town(folder_.path() / "town.map");
  catalog_ = open_catalog(folder_.path());
  const std::string path = "/viewer/maps/town/builds/" + town.build;
  EXPECT_EQ(problem_status(get(path + "/segments/s1/landmarks/0")), 500U);
  EXPECT_EQ(problem_status(get(path + "/walls/" + std::to_string(kTownCells[0]))), 500U);
}

TEST_F(ViewerTest, RecordOfTheMappingIsTheDocumentThatTheManifestLists) {
  const Response response = get(build_path("/v1") + "/mapping");
  EXPECT_EQ(response.header("Content-Type"), "application/json");
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(text_of(response), mapping_document(lane_.mapping));
  const json listed = json_of(get(build_path("/v1") + "/manifest")).at("mapping");
  EXPECT_EQ(response.header("ETag"), '"' + listed.at("digest").get<std::string>() + '"');
  EXPECT_EQ(get(build_path("/v1") + "/mapping", std::string(response.header("ETag"))).status, 304U);
}

TEST_F(ViewerTest, MapWithoutARecordHasNoneAndOldBuildsAreGone) {
  const TownMap town = write_town(folder_.path() / "town.map");
  catalog_ = open_catalog(folder_.path());
  const Response none = get("/v1/maps/town/builds/" + town.build + "/mapping");
  EXPECT_EQ(problem_status(none), 404U);
  EXPECT_THAT(detail_of(none), HasSubstr("the record of the mapping of map 'town'"));
  EXPECT_EQ(problem_status(get("/v1/maps/lane/builds/" + std::string(32, '0') + "/mapping")), 410U);
}

}  // namespace
}  // namespace milepost::server
