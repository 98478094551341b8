// The routes to cells, as a function of values.
#include <gmock/gmock.h>

#include "schema/base/digest.h"
#include "server/routes/handle.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class AreasTest : public ::testing::Test {
 protected:
  AreasTest() : town_(write_town(folder_.path() / "town.map")) {
    catalog_ = open_catalog(folder_.path());
  }

  Response get(const std::string& target, const std::string& if_none_match = "") const {
    return handle({"GET", target, if_none_match}, *catalog_);
  }

  std::string areas_path() const { return "/v1/maps/town/builds/" + town_.build + "/areas"; }
  std::string box_path(const std::string& bbox) const {
    return areas_path() + "/walls?bbox=" + bbox;
  }
  std::string cell_path(std::size_t i) const {
    return areas_path() + "/walls/" + std::to_string(kTownCells[i]);
  }

  // The numbers of the cells of a range response.
  std::vector<std::uint32_t> cells(const std::string& target) const {
    const Response response = get(target);
    EXPECT_EQ(response.status, 200U) << target;
    std::vector<std::uint32_t> numbers;
    for (const CellEntry* entry : std::get<CellList>(response.body).cells) {
      numbers.push_back(entry->cell);
    }
    return numbers;
  }

  TemporaryFolder folder_;
  TownMap town_;
  std::shared_ptr<const Catalog> catalog_;
};

TEST_F(AreasTest, IndexHasTheCellsOfEachLayerThatHasAny) {
  const Response response = get(areas_path());
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(response.header("ETag"), '"' + digest_of(as_bytes(text_of(response))) + '"');
  const json areas = json_of(response);
  ASSERT_EQ(areas.at("cells").size(), 1U);
  ASSERT_EQ(areas.at("cells").at("walls").size(), 3U);
  EXPECT_EQ(areas.at("cells").at("walls").at(0).at("cell"), kTownCells[0]);
  EXPECT_EQ(areas.at("cells").at("walls").at(1), json({{"cell", kTownCells[1]},
                                                       {"west_deg", 8.005},
                                                       {"south_deg", 49.0},
                                                       {"east_deg", 8.01},
                                                       {"north_deg", 49.005},
                                                       {"items", 21},
                                                       {"bytes", 1001},
                                                       {"digest", digest_of(town_.cells[1])}}));
}

TEST_F(AreasTest, BoxHoldsEveryCellThatMeetsItBordersIncluded) {
  const auto [corner, east, north] = std::to_array(kTownCells);
  EXPECT_THAT(cells(box_path("8,49,8.01,49.01")), ElementsAre(corner, east, north));
  EXPECT_THAT(cells(box_path("-180,-90,180,90")), ElementsAre(corner, east, north));
  EXPECT_THAT(cells(box_path("8.001,49.001,8.002,49.002")), ElementsAre(corner));
  EXPECT_THAT(cells(box_path("8.005,49.001,8.005,49.001")), ElementsAre(corner, east));
  EXPECT_THAT(cells(box_path("8.001,49.005,8.001,49.005")), ElementsAre(corner, north));
  EXPECT_THAT(cells(box_path("8.01,49,9,49.004")), ElementsAre(east));
  EXPECT_THAT(cells(box_path("7,48,8,49")), ElementsAre(corner));
  EXPECT_THAT(cells(box_path("7,48,7.9999,50")), IsEmpty());
  EXPECT_THAT(cells(box_path("8.0100001,49,9,50")), IsEmpty());
  EXPECT_THAT(cells(box_path("8,49.0100001,9,50")), IsEmpty());
  EXPECT_THAT(cells(box_path("8%2C49%2C8%2C49")), ElementsAre(corner));
}

TEST_F(AreasTest, BoxAnswersWhatTheStoreAnswers) {
  const Result<MapReader> reader = MapReader::open(folder_.path() / "town.map");
  ASSERT_TRUE(reader.ok());
  for (double west_deg = 7.99; west_deg < 8.02; west_deg += 0.001) {
    const Bounds box{west_deg, 49.0005, west_deg + 0.002, 49.0052};
    const auto stored = reader->cells_in("walls", box);
    ASSERT_TRUE(stored.ok());
    std::vector<std::uint32_t> numbers;
    for (const CellEntry& entry : *stored) numbers.push_back(entry.cell);
    EXPECT_EQ(cells(box_path(std::to_string(west_deg) + ",49.0005," +
                             std::to_string(west_deg + 0.002) + ",49.0052")),
              numbers)
        << west_deg;
  }
}

TEST_F(AreasTest, BoxGoesAcrossLongitude180) {
  const std::uint32_t west_end = 18000 * kCellColumns;  // its corner is 0 N 180 W
  const std::uint32_t middle = west_end + 36000;
  const std::uint32_t east_end = west_end + kCellColumns - 1;
  const std::string build =
      write_walls(folder_.path() / "islands.map", {west_end, middle, east_end});
  catalog_ = open_catalog(folder_.path());
  const std::string path = "/v1/maps/islands/builds/" + build + "/areas/walls?bbox=";
  EXPECT_THAT(cells(path + "179,0,-179,1"), ElementsAre(west_end, east_end));
  EXPECT_THAT(cells(path + "180,0,-180,1"), ElementsAre(west_end, east_end));
  EXPECT_THAT(cells(path + "179,0,180,1"), ElementsAre(east_end));
  EXPECT_THAT(cells(path + "-180,0,-179,1"), ElementsAre(west_end));
  EXPECT_THAT(cells(path + "0.001,0,-1,1"), ElementsAre(west_end, middle, east_end));
  EXPECT_THAT(cells(path + "179,1,-179,2"), IsEmpty());
}

TEST_F(AreasTest, BoxKnowsItsLengthAndTagBeforeReading) {
  const Response response = get(box_path("8,49,8.01,49.004"));
  EXPECT_EQ(response.header("Content-Type"), "application/octet-stream");
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(response.content_length(), 1000U + 1001U);
  EXPECT_NE(response.header("ETag"), "");
  EXPECT_EQ(response.header("ETag"), get(box_path("8,49,8.009,49.003")).header("ETag"));
  EXPECT_NE(response.header("ETag"), get(box_path("8,49,8.01,49.01")).header("ETag"));
}

TEST_F(AreasTest, BoxOfALayerWithoutCellsIsAnEmptyAnswer) {
  const Response response = get(areas_path() + "/tracklets?bbox=8,49,9,50");
  EXPECT_EQ(response.status, 200U);
  EXPECT_EQ(response.content_length(), 0U);
}

TEST_F(AreasTest, WrongBoxesAreToldApart) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "parameter bbox: is missing"},
      {"box=8,49,9,50", "parameter 'box': is unknown here; known are bbox"},
      {"bbox=8,49,9,50&bbox=8,49,9,50", "parameter bbox: is given more than once"},
      {"bbox=8,49,9,50&limit=1", "parameter 'limit': is unknown"},
      {"bbox=", "a side of bbox: is ''"},
      {"bbox=8,49,9", "parameter bbox: is not four numbers"},
      {"bbox=8,49,9,50,1", "parameter bbox: is not four numbers"},
      {"bbox=8,49,9,50,", "a side of bbox: is ''"},
      {"bbox=8,49,9,x", "a side of bbox: is 'x'"},
      {"bbox=8, 49,9,50", "a side of bbox: is ' 49'"},
      {"bbox=8;49;9;50", "a side of bbox: is '8;49;9;50'"},
      {"bbox=nan,49,9,50", "a side of bbox: is 'nan'"},
      {"bbox=8,49,9,NaN", "a side of bbox: is 'NaN'"},
      {"bbox=8,49,inf,50", "parameter bbox: is out of range"},
      {"bbox=-inf,49,9,50", "parameter bbox: is out of range"},
      {"bbox=8,-inf,9,inf", "parameter bbox: is out of range"},
      {"bbox=8,49,1e999,50", "a side of bbox: is '1e999'"},
      {"bbox=-180.1,49,9,50", "parameter bbox: is out of range"},
      {"bbox=8,49,180.1,50", "parameter bbox: is out of range"},
      {"bbox=8,-90.1,9,50", "parameter bbox: is out of range"},
      {"bbox=8,49,9,90.1", "parameter bbox: is out of range"},
      {"bbox=8,50,9,49", "parameter bbox: south is greater than north"},
  };
  for (const auto& [query, detail] : cases) {
    const Response response = get(areas_path() + "/walls?" + query);
    EXPECT_EQ(problem_status(response), 400U) << query;
    EXPECT_THAT(detail_of(response), HasSubstr(detail)) << query;
  }
  EXPECT_EQ(problem_status(get(areas_path() + "?bbox=8,49,9,50")), 400U);
}

TEST_F(AreasTest, CellHasItsDigestAsTag) {
  const Response response = get(cell_path(2));
  EXPECT_EQ(response.status, 200U);
  EXPECT_EQ(response.header("ETag"), '"' + digest_of(town_.cells[2]) + '"');
  EXPECT_EQ(response.header("Cache-Control"), kImmutable);
  EXPECT_EQ(response.content_length(), 1002U);
}

TEST_F(AreasTest, AbsentThingsAre404) {
  const std::string elsewhere = "/v1/maps/nowhere/builds/" + town_.build + "/areas";
  for (const std::string& target :
       {elsewhere, elsewhere + "/walls?bbox=8,49,9,50",
        elsewhere + "/walls/" + std::to_string(kTownCells[0]),
        areas_path() + "/roofs?bbox=8,49,9,50", areas_path() + "/roofs/1",
        areas_path() + "/walls/0", areas_path() + "/walls/2591999999",
        areas_path() + "/walls/4294967295", areas_path() + "/", areas_path() + "/walls/",
        areas_path() + "/tracklets/" + std::to_string(kTownCells[0])}) {
    EXPECT_EQ(problem_status(get(target)), 404U) << target;
  }
  EXPECT_THAT(detail_of(get(areas_path() + "/walls/0")), HasSubstr("cell 0: does not exist"));
}

TEST_F(AreasTest, AnotherBuildIs410AndNamesTheCurrentOne) {
  const std::string old = "/v1/maps/town/builds/" + std::string(32, '0') + "/areas";
  for (const char* rest : {"", "/walls?bbox=8,49,9,50", "/walls/1", "/never/1"}) {
    const Response response = get(old + rest);
    EXPECT_EQ(problem_status(response), 410U) << rest;
    EXPECT_THAT(detail_of(response), HasSubstr(town_.build));
  }
}

TEST_F(AreasTest, MalformedPathsAre400) {
  for (const std::string& target :
       {std::string("/v1/maps/town/builds/latest/areas"), areas_path() + "/.walls?bbox=8,49,9,50",
        areas_path() + "/a%2Fb/1", areas_path() + "/walls/07", areas_path() + "/walls/-1",
        areas_path() + "/walls/+1", areas_path() + "/walls/1x", areas_path() + "/walls/1e3",
        areas_path() + "/walls/4294967296"}) {
    EXPECT_EQ(problem_status(get(target)), 400U) << target;
  }
}

TEST_F(AreasTest, KnownTagIs304WithoutBody) {
  for (const std::string& target :
       {areas_path(), box_path("8,49,9,50"), box_path("1,1,2,2"), cell_path(1)}) {
    const Response fresh = get(target);
    ASSERT_EQ(fresh.status, 200U) << target;
    const Response known = get(target, std::string(fresh.header("ETag")));
    EXPECT_EQ(known.status, 304U) << target;
    EXPECT_EQ(known.content_length(), 0U);
    EXPECT_EQ(known.header("Cache-Control"), kImmutable);
    EXPECT_EQ(get(target, "\"other\"").status, 200U) << target;
  }
}

TEST_F(AreasTest, MapOfWallsAloneIsServedLikeAnyOther) {
  const std::string build = write_walls(folder_.path() / "blocks.map", {kTownCells[2]});
  catalog_ = open_catalog(folder_.path());
  const json map = json_of(get("/v1/maps/blocks"));
  EXPECT_EQ(map.at("build"), build);
  EXPECT_EQ(map.at("layers"), json({"walls"}));
  EXPECT_EQ(map.at("layer_parameters").at("walls"), json({{"items", "walls"}}));
  EXPECT_EQ(map.at("feature"), json::object());
  EXPECT_EQ(map.at("segments"), json::array());
  EXPECT_EQ(map.at("length_m"), 0);
  EXPECT_EQ(
      map.at("bounds"),
      json({{"west_deg", 8.0}, {"south_deg", 49.005}, {"east_deg", 8.005}, {"north_deg", 49.01}}));
  const json near = json_of(get("/v1/segments?near=49.006,8.001&radius_m=10000")).at("segments");
  ASSERT_EQ(near.size(), 2U);
  EXPECT_EQ(near.at(0).at("map"), "town");
  EXPECT_TRUE(json_of(get("/v1/segments?near=0,0&radius_m=10000")).at("segments").empty());
}

}  // namespace
}  // namespace milepost::server
