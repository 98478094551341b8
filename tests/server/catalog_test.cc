#include "server/catalog/catalog.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "schema/base/file.h"
#include "schema/store/sqlite.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

class CatalogTest : public ::testing::Test {
 protected:
  Result<std::shared_ptr<const Catalog>> open() {
    warnings_.clear();
    return Catalog::open(folder_.path(), CatalogSettings(),
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
  write("empty", "");
  write(".hidden", "unfinished");
  write(".town.map.partial-7", "unfinished");
  fs::create_directory(folder_.path() / "archive");
  auto database = sqlite::Database::open(folder_.path() / "other.db", sqlite::Access::read_write);
  ASSERT_TRUE(database->execute("CREATE TABLE t (a)").ok());

  const auto catalog = open();
  ASSERT_TRUE(catalog.ok()) << catalog.error().line();
  EXPECT_EQ((*catalog)->maps().size(), 1U);
  EXPECT_TRUE((*catalog)->maps().contains("town"));
  EXPECT_EQ((*catalog)->left_out(), 0U);
  EXPECT_THAT(warnings_, UnorderedElementsAre(HasSubstr("README.txt: is not a milepost map"),
                                              HasSubstr("archive: is a directory"),
                                              HasSubstr("empty: is empty"),
                                              HasSubstr("other.db: is not a milepost map")));
}

TEST_F(CatalogTest, NameOfTheFileDoesNotDecideWhatIsAMap) {
  write_town(folder_.path() / "town");
  EXPECT_TRUE((*open())->maps().contains("town"));
}

// A file next to a good map that cannot be served, and the reason.
class LeftOutTest : public CatalogTest {
 protected:
  LeftOutTest() { write_town(folder_.path() / "good.map"); }

  // The good map is still served, and the only warning is the reason for `name`.
  void expect_left_out(const std::string& name, const std::string& reason) {
    const auto catalog = open();
    ASSERT_TRUE(catalog.ok()) << catalog.error().line();
    EXPECT_EQ((*catalog)->maps().size(), 1U);
    EXPECT_TRUE((*catalog)->maps().contains("good"));
    EXPECT_EQ((*catalog)->left_out(), 1U);
    EXPECT_THAT(warnings_, ElementsAre(AllOf(StartsWith((folder_.path() / name).string()),
                                             HasSubstr(reason), HasSubstr("; "))));
  }

  void change_town(const std::string& sql) {
    auto database = sqlite::Database::open(town_, sqlite::Access::read_write);
    ASSERT_TRUE(database.ok());
    const Status changed = database->execute(sql);
    ASSERT_TRUE(changed.ok()) << changed.error().line();
  }

  const fs::path town_ = folder_.path() / "town.map";
};

TEST_F(LeftOutTest, EmptyFile) {
  write("town.map", "");
  expect_left_out("town.map", "is empty");
}

TEST_F(LeftOutTest, FileOfAnotherKind) {
  write("town.map", "filename,timestamp_s\n");
  expect_left_out("town.map", "is not a milepost map and is skipped");
}

TEST_F(LeftOutTest, DatabaseOfAnotherProgram) {
  change_town("CREATE TABLE t (a)");
  expect_left_out("town.map", "is not a milepost map and is skipped");
}

TEST_F(LeftOutTest, Directory) {
  fs::create_directory(town_);
  expect_left_out("town.map", "is a directory");
}

TEST_F(LeftOutTest, FifoThatNobodyWritesTo) {
  ASSERT_EQ(mkfifo(town_.c_str(), 0600), 0);
  expect_left_out("town.map", "is a FIFO");
}

TEST_F(LeftOutTest, Socket) {
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  town_.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(::bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  expect_left_out("town.map", "is a socket");
  ::close(descriptor);
}

TEST_F(LeftOutTest, Device) {
  fs::create_symlink("/dev/zero", town_);
  expect_left_out("town.map", "is a device");
}

TEST_F(LeftOutTest, DanglingLink) {
  fs::create_symlink("elsewhere/town.map", town_);
  expect_left_out("town.map", "is a link to elsewhere/town.map, which does not exist");
}

TEST_F(LeftOutTest, LinkToItself) {
  fs::create_symlink("town.map", town_);
  expect_left_out("town.map", "cannot be reached (Too many levels of symbolic links)");
}

TEST_F(LeftOutTest, HalfCopiedMap) {
  write_town(town_, 100'000);
  const auto whole = fs::file_size(town_);
  for (const std::uintmax_t bytes :
       {whole - 1, whole / 2, std::uintmax_t{8192}, std::uintmax_t{90}, std::uintmax_t{16}}) {
    fs::resize_file(town_, bytes);
    expect_left_out("town.map", "is truncated");
  }
}

TEST_F(LeftOutTest, DamagedMap) {
  write_town(town_);
  std::fstream file(town_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(100);
  file << std::string(3000, '\xff');
  file.close();
  expect_left_out("town.map", "malformed");
}

// A damaged length is ignored.
TEST_F(LeftOutTest, DamagedHeader) {
  write_town(town_);
  std::fstream file(town_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(16);  // the length of a page
  file << "xx";
  file.close();
  expect_left_out("town.map", "file is not a database");
}

TEST_F(LeftOutTest, MapOfAnotherFormatVersion) {
  write_town(town_);
  change_town("PRAGMA user_version = 1");
  expect_left_out("town.map", "this is a map of format version 1, not 3; build the map anew");
}

TEST_F(LeftOutTest, MapWithoutATable) {
  write_town(town_);
  change_town("DROP TABLE successors");
  expect_left_out("town.map", "no such table: successors");
}

// Found at the start, though the first tile is read later.
TEST_F(LeftOutTest, MapWithoutTheTableOfItsTiles) {
  write_town(town_);
  change_town("ALTER TABLE frames RENAME TO pictures");
  expect_left_out("town.map", "no such table column: frames");
  write_town(town_);
  change_town("ALTER TABLE frames RENAME COLUMN frame TO picture");
  expect_left_out("town.map", "no such table column: frames.frame");
}

TEST_F(LeftOutTest, ParametersThatAreNoJson) {
  write_town(town_);
  change_town("UPDATE layers SET parameters = '{' WHERE name = 'walls'");
  expect_left_out("town.map, layer walls", "this is not JSON");
  change_town("UPDATE layers SET parameters = '[]' WHERE name = 'walls'");
  expect_left_out("town.map, layer walls", "the parameters are not a JSON object");
}

// Deeply nested arrays would overflow the stack of code that traverses them.
TEST_F(LeftOutTest, ParametersThatAreNestedTooDeep) {
  std::string deep = "{\"a\": ";
  for (int i = 0; i < 100'000; ++i) deep += '[';
  for (int i = 0; i < 100'000; ++i) deep += ']';
  deep += '}';
  write_town(town_);
  change_town("UPDATE layers SET parameters = '" + deep + "' WHERE name = 'walls'");
  expect_left_out("town.map, layer walls", "nested");
  write_town(town_);
  change_town("UPDATE meta SET value = '" + deep + "' WHERE key = 'feature'");
  expect_left_out("town.map, feature parameters", "nested");
}

TEST_F(LeftOutTest, LineWithoutLength) {
  write_town(town_);
  change_town("DELETE FROM vertices WHERE segment = 's2'");
  expect_left_out("town.map, segment s2", "a line needs two or more vertices");
}

// Such a name has no URL, and no JSON text can hold it.
TEST_F(LeftOutTest, NamesInTheMapThatAreNone) {
  write_town(town_);
  change_town("UPDATE segments SET id = CAST(x'73ff' AS TEXT) WHERE id = 's2'");
  expect_left_out("town.map", "a segment's name");
  write_town(town_);
  change_town("UPDATE layers SET name = CAST(x'73ff' AS TEXT) WHERE name = 'walls'");
  expect_left_out("town.map", "a layer's name");
  write_town(town_);
  change_town("UPDATE successors SET successor = CAST(x'73ff' AS TEXT)");
  expect_left_out("town.map, segment s1", "a successor is not a segment id");
}

TEST_F(LeftOutTest, NameThatCannotStandInAUrl) {
  write_town(folder_.path() / "my town.map");
  expect_left_out("my town.map", "the map's name 'my town' cannot be used in a URL");
}

TEST_F(LeftOutTest, CopiesAndPartsOfMaps) {
  for (const char* name :
       {"town.map.bak", "town.map.1", "town.map~", "town.map-old", "town.map.map", "town.db.2026",
        "town.MAP.save", "town.bak", "town.old", "town.orig", "town.tmp", "town.part",
        "town.v2.map.partial", "town.map.v2.map"}) {
    const fs::path file = folder_.path() / name;
    write_town(file);
    expect_left_out(name, "is named like a copy or a part of a map");
    fs::remove(file);
  }
}

TEST_F(CatalogTest, DotsInANameAreNoCopies) {
  const std::vector<std::string> names = {"us.mapleton", "town.v2", "map", "map.of.bak.street"};
  for (const std::string& name : names) write_town(folder_.path() / (name + ".map"));
  const auto catalog = open();
  ASSERT_TRUE(catalog.ok()) << catalog.error().line();
  EXPECT_EQ((*catalog)->left_out(), 0U);
  for (const std::string& name : names) EXPECT_TRUE((*catalog)->maps().contains(name)) << name;
}

TEST_F(CatalogTest, OfTwoMapsOfOneNameTheFileDotMapIsServed) {
  write_town(folder_.path() / "town", 10, 3);
  write_town(folder_.path() / "town.db", 10, 1);
  const TownMap town = write_town(folder_.path() / "town.map", 10, 2);
  const auto catalog = open();
  ASSERT_TRUE(catalog.ok()) << catalog.error().line();
  EXPECT_EQ((*catalog)->maps().at("town")->build, town.build);
  EXPECT_EQ((*catalog)->left_out(), 2U);
  const auto same =
      AllOf(HasSubstr("has the same map name 'town' as"), HasSubstr("town.map; rename"));
  EXPECT_THAT(warnings_, UnorderedElementsAre(AllOf(HasSubstr("/town: "), same),
                                              AllOf(HasSubstr("/town.db: "), same)));
}

TEST_F(CatalogTest, OfTwoMapsOfOneNameWithoutDotMapNoneIsServed) {
  write_town(folder_.path() / "good.map");
  write_town(folder_.path() / "town", 10, 3);
  write_town(folder_.path() / "town.db", 10, 1);
  const auto catalog = open();
  ASSERT_TRUE(catalog.ok()) << catalog.error().line();
  EXPECT_FALSE((*catalog)->maps().contains("town"));
  EXPECT_EQ((*catalog)->left_out(), 2U);
  EXPECT_THAT(warnings_,
              UnorderedElementsAre(AllOf(HasSubstr("/town: "), HasSubstr("/town.db; ")),
                                   AllOf(HasSubstr("/town.db: "), HasSubstr("/town; "))));
}

// Root may read everything, so a process of another user reads.
TEST_F(LeftOutTest, FileThatMayNotBeRead) {
  write_town(town_);
  ASSERT_EQ(chmod(town_.c_str(), 0), 0);
  ASSERT_EQ(chmod(folder_.path().c_str(), 0755), 0);
  const pid_t reader = fork();
  if (reader == 0) {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(1);
    expect_left_out("town.map", "cannot be opened (Permission denied)");
    _exit(HasFailure() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(reader, &status, 0), reader);
  EXPECT_EQ(status, 0);
}

TEST_F(CatalogTest, OneBadMapAloneIsTheError) {
  const fs::path file = folder_.path() / "town.map";
  write_town(file, 100'000);
  fs::resize_file(file, 8192);
  EXPECT_THAT(error_line(), HasSubstr("town.map: is truncated"));
  EXPECT_THAT(warnings_, ElementsAre());
}

TEST_F(CatalogTest, BadMapsAloneAreAnErrorWithEachReason) {
  write("a.map", "");
  write("b.map", "text");
  EXPECT_THAT(error_line(), HasSubstr(": none of its 2 maps can be served; "));
  EXPECT_THAT(warnings_,
              ElementsAre(HasSubstr("a.map: is empty"), HasSubstr("b.map: is not a milepost map")));
}

TEST_F(CatalogTest, MissingDirectoryIsNamed) {
  const auto catalog =
      Catalog::open(folder_.path() / "none", CatalogSettings(), [](const std::string&) {});
  ASSERT_FALSE(catalog.ok());
  EXPECT_EQ(catalog.error().code, ErrorCode::not_found);
  EXPECT_THAT(catalog.error().line(), HasSubstr("/none: there is no such directory"));
}

TEST_F(CatalogTest, FileInPlaceOfTheDirectoryIsNamed) {
  write("file", "");
  const auto catalog =
      Catalog::open(folder_.path() / "file", CatalogSettings(), [](const std::string&) {});
  ASSERT_FALSE(catalog.ok());
  EXPECT_EQ(catalog.error().code, ErrorCode::io);
  EXPECT_THAT(catalog.error().line(), HasSubstr("/file: cannot be listed"));
}

TEST_F(CatalogTest, OpenMapGoesOnServingAfterTheFileIsReplaced) {
  const TownMap first = write_town(folder_.path() / "town.map", 1000, 1);
  const auto catalog = open();
  ASSERT_TRUE(catalog.ok());
  write_town(folder_.path() / "town.map", 1000, 2);
  const auto map = served_map(**catalog, "town");
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
  const auto map = served_map(**catalog, "town");
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
  const auto map = served_map(**catalog, "town");
  CellEntry entry = map->cells().at("walls")[1];
  EXPECT_EQ(*map->cell("walls", entry), town.cells[1]);
  entry.bytes += 1;
  const Result<Bytes> cell = map->cell("walls", entry);
  ASSERT_FALSE(cell.ok());
  EXPECT_THAT(cell.error().line(),
              HasSubstr("town.map, layer walls, cell " + std::to_string(entry.cell)));
}

}  // namespace
}  // namespace milepost::server
