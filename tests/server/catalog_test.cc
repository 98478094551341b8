#include "server/catalog/catalog.h"

#include <gmock/gmock.h>

#include <fstream>

#include "schema/base/file.h"
#include "schema/store/sqlite.h"
#include "server/catalog/degree_box.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class CatalogTest : public testing::Test {
 protected:
  Result<std::shared_ptr<const Catalog>> open() {
    warnings_.clear();
    return Catalog::open(folder_.path(), 1,
                         [this](const std::string& line) { warnings_.push_back(line); });
  }

  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
  }

  std::string error_line() {
    const auto catalog = open();
    return catalog ? "no error" : catalog.error().line();
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(CatalogTest, OtherFilesAreSkippedWithAWarning) {
  write_town(folder_.path() / "town.map");
  write("README.txt", "maps of the town\n");
  write("empty.map", "");
  write(".hidden", "unfinished");
  fs::create_directory(folder_.path() / "folder.map");
  auto database = sqlite::Database::open(folder_.path() / "other.db", sqlite::Access::read_write);
  ASSERT_TRUE(database->execute("CREATE TABLE t (a)").ok());

  const auto catalog = open();
  ASSERT_TRUE(catalog.ok()) << catalog.error().line();
  EXPECT_EQ((*catalog)->maps().size(), 1U);
  EXPECT_TRUE((*catalog)->maps().contains("town"));
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("README.txt"), HasSubstr("empty.map"),
                                     HasSubstr("other.db: is no milepost map")));
}

TEST_F(CatalogTest, NameOfTheFileDoesNotDecideWhatIsAMap) {
  write_town(folder_.path() / "town");
  EXPECT_TRUE((*open())->maps().contains("town"));
}

TEST_F(CatalogTest, TwoMapsOfOneNameAreRefused) {
  write_town(folder_.path() / "town.db", 10, 1);
  write_town(folder_.path() / "town.map", 10, 2);
  EXPECT_THAT(error_line(), AllOf(HasSubstr("town.map: has the same map name 'town'"),
                                  HasSubstr("town.db"), HasSubstr("rename")));
}

TEST_F(CatalogTest, NameThatCannotStandInAUrlIsRefused) {
  write_town(folder_.path() / "my town.map");
  EXPECT_THAT(error_line(), AllOf(HasSubstr("my town.map"), HasSubstr("rename the file")));
}

TEST_F(CatalogTest, CorruptMapIsRefusedByName) {
  const fs::path file = folder_.path() / "town.map";
  write_town(file, 100'000);
  fs::resize_file(file, 8192);
  EXPECT_THAT(error_line(), HasSubstr("town.map"));
  EXPECT_FALSE(open().ok());
}

TEST_F(CatalogTest, ParametersThatAreNoJsonAreRefused) {
  const fs::path file = folder_.path() / "town.map";
  write_town(file);
  auto database = sqlite::Database::open(file, sqlite::Access::read_write);
  ASSERT_TRUE(database->execute("UPDATE layers SET parameters = '{' WHERE name = 'walls'").ok());
  EXPECT_THAT(error_line(), AllOf(HasSubstr("town.map, layer walls"), HasSubstr("no JSON object")));
}

TEST_F(CatalogTest, LineWithoutLengthIsRefused) {
  const fs::path file = folder_.path() / "town.map";
  write_town(file);
  auto database = sqlite::Database::open(file, sqlite::Access::read_write);
  ASSERT_TRUE(database->execute("DELETE FROM vertices WHERE segment = 's2'").ok());
  EXPECT_THAT(error_line(), HasSubstr("town.map, segment s2"));
}

TEST_F(CatalogTest, MissingDirectoryIsNamed) {
  const auto catalog = Catalog::open(folder_.path() / "none", 1, [](const std::string&) {});
  ASSERT_FALSE(catalog.ok());
  EXPECT_EQ(catalog.error().code, ErrorCode::not_found);
  EXPECT_THAT(catalog.error().line(), HasSubstr("/none: there is no such directory"));
}

TEST_F(CatalogTest, FileInPlaceOfTheDirectoryIsNamed) {
  write("file", "");
  const auto catalog = Catalog::open(folder_.path() / "file", 1, [](const std::string&) {});
  ASSERT_FALSE(catalog.ok());
  EXPECT_EQ(catalog.error().code, ErrorCode::io);
  EXPECT_THAT(catalog.error().line(), HasSubstr("/file: cannot be listed"));
}

TEST_F(CatalogTest, OpenMapGoesOnServingAfterTheFileIsReplaced) {
  const TownMap first = write_town(folder_.path() / "town.map", 1000, 1);
  const auto catalog = open();
  ASSERT_TRUE(catalog.ok());
  write_town(folder_.path() / "town.map", 1000, 2);
  const auto& map = (*catalog)->maps().at("town");
  EXPECT_EQ(map->build(), first.build);
  const TileEntry& entry = map->segments().at("s1").tiles.at("tracklets")[0];
  const Result<Bytes> tile = map->tile("s1", "tracklets", entry);
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(*tile, first.frames[0]);
}

TEST_F(CatalogTest, TileOfAnotherLengthThanPromisedIsCorrupt) {
  write_town(folder_.path() / "town.map");
  const auto catalog = open();
  ASSERT_TRUE(catalog.ok());
  const auto& map = (*catalog)->maps().at("town");
  TileEntry entry = map->segments().at("s1").tiles.at("tracklets")[1];
  entry.bytes += 1;
  const Result<Bytes> tile = map->tile("s1", "tracklets", entry);
  ASSERT_FALSE(tile.ok());
  EXPECT_THAT(tile.error().line(), HasSubstr("town.map, segment s1, layer tracklets, tile 1"));
}

TEST_F(CatalogTest, CellOfAnotherLengthThanPromisedIsCorrupt) {
  const TownMap town = write_town(folder_.path() / "town.map");
  const auto catalog = open();
  ASSERT_TRUE(catalog.ok());
  const auto& map = (*catalog)->maps().at("town");
  CellEntry entry = map->cells().at("walls")[1];
  EXPECT_EQ(*map->cell("walls", entry), town.cells[1]);
  entry.bytes += 1;
  const Result<Bytes> cell = map->cell("walls", entry);
  ASSERT_FALSE(cell.ok());
  EXPECT_THAT(cell.error().line(),
              HasSubstr("town.map, layer walls, cell " + std::to_string(entry.cell)));
}

// The reach of a box is checked against geodesics.
TEST(DegreeBoxTest, NeverRulesOutWhatIsWithin) {
  const std::vector<GeoPoint> corners = {{0, 0, 0},      {60, 10, 0},      {-60, -10, 0},
                                         {85, 179.9, 0}, {0, -179.999, 0}, {89.99, 0, 0}};
  for (const GeoPoint& corner : corners) {
    const DegreeBox box = DegreeBox::around({corner});
    for (int direction = 0; direction < 360; direction += 15) {
      const LocalFrame frame(corner);
      const double angle = direction * 3.14159265358979 / 180;
      const GeoPoint there =
          frame.geo_from_enu({4000 * std::sin(angle), 4000 * std::cos(angle), 0});
      const double distance_m = geodesic_distance_m(corner, there);
      EXPECT_TRUE(box.may_be_within(there, distance_m)) << corner.latitude_deg << ' ' << direction;
    }
  }
}

TEST(DegreeBoxTest, RulesOutWhatIsFar) {
  const DegreeBox box = DegreeBox::around({{49, 8, 0}, {49.01, 8.02, 0}});
  EXPECT_TRUE(box.may_be_within({49.005, 8.01, 0}, 1));
  EXPECT_TRUE(box.may_be_within({49.0105, 8.01, 0}, 60));
  EXPECT_FALSE(box.may_be_within({49.0105, 8.01, 0}, 50));
  EXPECT_TRUE(box.may_be_within({49.005, 8.021, 0}, 80));
  EXPECT_FALSE(box.may_be_within({49.005, 8.021, 0}, 60));
  EXPECT_FALSE(box.may_be_within({49.005, -172, 0}, 10000));
  const DegreeBox west = DegreeBox::around({{0, -179.9999, 0}});
  EXPECT_TRUE(west.may_be_within({0, 179.9999, 0}, 30));
  EXPECT_FALSE(west.may_be_within({0, 179.9999, 0}, 10));
}

}  // namespace
}  // namespace milepost::server
