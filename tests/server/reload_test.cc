// Maps that come, go, and take the place of others while they are served.
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

#include "server/catalog/reloader.h"
#include "server/hot/frames_of.h"
#include "server/hot/prepared.h"
#include "server/routes/handle.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class ReloadTest : public ::testing::Test {
 protected:
  ReloadTest() { settings_.keep = 60s; }

  void open() {
    const auto opened = Catalog::open(folder_.path(), settings_, warn());
    ASSERT_TRUE(opened.ok()) << opened.error().line();
    catalog_ = *opened;
  }
  // As much later, by a look at all files.
  void reload(std::chrono::seconds later = 0s) { reload(later, {{}, true}); }
  void reload(std::chrono::seconds later, const DirectoryChanges& changes) {
    now_ += later;
    warnings_.clear();
    const auto reloaded = catalog_->reloaded(now_, warn(), changes);
    ASSERT_TRUE(reloaded.ok()) << reloaded.error().line();
    catalog_ = *reloaded;
  }
  TownMap write(unsigned seed, const std::string& name = "town.map") const {
    return write_town(folder_.path() / name, 100, seed);
  }
  // Writes over the file of a map, whose content is lost with that.
  void write_over(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.path() / name, std::ios::binary | std::ios::trunc) << content;
  }

  Response get(const std::string& target) const { return handle({"GET", target, ""}, *catalog_); }
  static std::string tile_path(const std::string& build) {
    return "/v1/maps/town/builds/" + build + "/segments/s1/tiles/tracklets/0";
  }
  // The status, or the bytes of the tile.
  std::string tile_of(const std::string& build) const {
    const Response response = get(tile_path(build));
    if (response.status != 200) return std::to_string(response.status);
    HotFrames memory(1);  // none
    const auto frames = read_frames(response, *map_of(response), 0, memory);
    return frames ? std::string(as_text(*frames->front())) : frames.error().line();
  }
  static std::string text(const Bytes& bytes) { return std::string(as_text(bytes)); }
  std::string readiness() const { return text_of(get("/readyz")); }

  Warn warn() {
    return [this](const std::string& line) { warnings_.push_back(line); };
  }

  TemporaryFolder folder_;
  CatalogSettings settings_;
  std::shared_ptr<const Catalog> catalog_;
  std::vector<std::string> warnings_;
  Catalog::Clock::time_point now_ = Catalog::Clock::now();
};

TEST_F(ReloadTest, ABuildThatIsReplacedStaysForItsTimeAndIsGoneThen) {
  const TownMap first = write(1);
  open();
  const TownMap second = write(2);
  reload();
  EXPECT_THAT(text_of(get("/v1/maps")), HasSubstr(second.build));
  EXPECT_THAT(text_of(get("/v1/maps")), Not(HasSubstr(first.build)));
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));
  EXPECT_EQ(tile_of(second.build), text(second.frames[0]));
  ASSERT_TRUE(catalog_->next_change().has_value());
  EXPECT_EQ(*catalog_->next_change(), now_ + 60s);
  reload(59s);
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));
  reload(1s);
  EXPECT_EQ(tile_of(first.build), "410");
  EXPECT_THAT(text_of(get(tile_path(first.build))), HasSubstr("use build " + second.build));
  EXPECT_FALSE(catalog_->next_change().has_value());
}

TEST_F(ReloadTest, AMapThatIsTakenAwayIsGoneAfterTheSameTime) {
  const TownMap town = write(1);
  write(3, "village.map");
  open();
  fs::remove(folder_.path() / "town.map");
  reload();
  EXPECT_THAT(text_of(get("/v1/maps")), Not(HasSubstr("town")));
  EXPECT_EQ(get("/v1/maps/town").status, 404U);
  EXPECT_THAT(text_of(get("/v1/segments?near=49,8&radius_m=100")), Not(HasSubstr("\"town\"")));
  EXPECT_EQ(tile_of(town.build), text(town.frames[0]));
  reload(61s);
  EXPECT_EQ(tile_of(town.build), "404");
  EXPECT_EQ(get("/v1/maps/village").status, 200U);
}

TEST_F(ReloadTest, AnOlderBuildBecomesTheCurrentOneAgain) {
  const TownMap first = write(1);
  fs::copy_file(folder_.path() / "town.map", folder_.path() / ".first");
  open();
  const TownMap second = write(2);
  reload();
  fs::rename(folder_.path() / ".first", folder_.path() / "town.map");
  reload(10s);
  EXPECT_EQ(catalog_->maps().at("town")->build, first.build);
  EXPECT_EQ(tile_of(second.build), text(second.frames[0]));
  reload(70s);
  EXPECT_EQ(tile_of(second.build), "410");
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));
}

TEST_F(ReloadTest, AFileThatCannotBeServedLeavesTheBuildBeforeItServed) {
  const TownMap first = write(1);
  open();
  std::ofstream(folder_.path() / ".half") << "SQLite";
  fs::rename(folder_.path() / ".half", folder_.path() / "town.map");
  reload();
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("town.map: is not a milepost map")));
  EXPECT_EQ(catalog_->maps().at("town")->build, first.build);
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));
  EXPECT_THAT(readiness(), AllOf(HasSubstr("ok\n"), HasSubstr("left out: "),
                                 HasSubstr("town.map: is not a milepost map")));
  reload(1000s);
  EXPECT_THAT(warnings_, IsEmpty());  // it was told
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));
  fs::remove(folder_.path() / "town.map");
  const TownMap second = write(2);
  reload();
  EXPECT_EQ(catalog_->maps().at("town")->build, second.build);
  EXPECT_EQ(readiness(), "ok\n");
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));
}

TEST_F(ReloadTest, WhatDidNotChangeIsNotReadAgain) {
  write(1);
  write(2, "village.map");
  open();
  const auto before = catalog_->maps();
  write(3, "village.map");
  reload();
  EXPECT_EQ(catalog_->maps().at("town"), before.at("town"));
  EXPECT_NE(catalog_->maps().at("village"), before.at("village"));
  const auto again = catalog_;
  reload();
  EXPECT_TRUE(catalog_->is_same(*again));
}

TEST_F(ReloadTest, OnlyWhatChangedIsLookedAt) {
  const TownMap town = write(1);
  const TownMap lost = write(3, "lost.map");
  open();
  const TownMap new_town = write(2);
  const TownMap village = write(4, "village.map");
  fs::remove(folder_.path() / "lost.map");
  write(5, ".hidden.map");
  write_over("list.map", "eggs");
  const auto files = [this](const std::vector<std::string>& names) {
    DirectoryChanges changes;
    for (const std::string& name : names) changes.files.insert(folder_.path() / name);
    return changes;
  };
  const auto builds = [this] {
    std::map<std::string, std::string> found;
    for (const auto& [name, build] : catalog_->maps()) found[name] = build->build;
    return found;
  };
  using Builds = std::map<std::string, std::string>;
  reload(0s, {});
  EXPECT_EQ(builds(), (Builds{{"town", town.build}, {"lost", lost.build}}));
  reload(0s, files({"village.map", ".hidden.map", "town.map.sig"}));
  EXPECT_EQ(builds(),
            (Builds{{"town", town.build}, {"lost", lost.build}, {"village", village.build}}));
  reload(0s, files({"lost.map", "town.map", "list.map", "never.map"}));
  EXPECT_EQ(builds(), (Builds{{"town", new_town.build}, {"village", village.build}}));
  EXPECT_THAT(readiness(), HasSubstr("list.map"));
  EXPECT_EQ(tile_of(town.build), text(town.frames[0]));
  const auto before = catalog_;
  reload();
  EXPECT_TRUE(before->is_same(*catalog_));
}

TEST_F(ReloadTest, ReadinessIs503WhereASettingAsksForAllMaps) {
  settings_.all_must_be_served = true;
  write(1);
  open();
  EXPECT_EQ(get("/readyz").status, 200U);
  write_over("half.map", "");
  reload();
  EXPECT_EQ(get("/readyz").status, 503U);
  EXPECT_EQ(get("/readyz").header("Retry-After"), "10");
  EXPECT_THAT(readiness(), AllOf(HasSubstr("not ready\n"), HasSubstr("half.map: is empty")));
}

TEST_F(ReloadTest, AFileThatIsDamagedWhileItIsServedIsToldAndNeverSent) {
  const TownMap town = write(1);
  open();
  // Past the first page, so that the file still looks like a map.
  const auto size = fs::file_size(folder_.path() / "town.map");
  std::fstream file(folder_.path() / "town.map", std::ios::in | std::ios::out | std::ios::binary);
  for (std::uintmax_t at = 4096; at < size; at += 16) file.seekp(static_cast<long>(at)).put('!');
  file.close();
  EXPECT_THAT(tile_of(town.build), HasSubstr("town.map"));
  EXPECT_THAT(readiness(), AllOf(HasSubstr("damaged: build " + town.build + " of map town: ")));
  // What was written over is lost; the next sound file is served, and nothing is told any more.
  const TownMap second = write(2);
  reload();
  EXPECT_EQ(readiness(), "ok\n");
  EXPECT_EQ(tile_of(second.build), text(second.frames[0]));
}

TEST_F(ReloadTest, ABuildThatWasWrittenOverIsNotKept) {
  const TownMap first = write(1);
  const TownMap second = write(2, ".other");
  open();
  std::ifstream other(folder_.path() / ".other", std::ios::binary);
  write_over("town.map", {std::istreambuf_iterator<char>(other), {}});
  reload();
  EXPECT_EQ(tile_of(first.build), "410");
  EXPECT_EQ(tile_of(second.build), text(second.frames[0]));
  EXPECT_EQ(readiness(), "ok\n");
}

TEST_F(ReloadTest, ABuildThatWasNotHeldOpenIsGoneOnceAnotherTookItsPlace) {
  settings_.kept.held_files = 0;
  settings_.open_maps.maps = 1;
  const TownMap first = write(1);
  open();
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));
  const TownMap second = write(2);
  EXPECT_EQ(tile_of(first.build), text(first.frames[0]));  // in memory
  reload();
  EXPECT_EQ(tile_of(second.build), text(second.frames[0]));
  EXPECT_EQ(tile_of(first.build), "410");
}

std::size_t open_descriptors() {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

TEST_F(ReloadTest, DescriptorsAreBoundedWhateverTheNumberOfMaps) {
  settings_.kept.held_files = 5;
  settings_.open_maps.maps = 3;
  settings_.open_maps.readers = 2;
  write(1, "m0.map");
  for (int i = 1; i < 40; ++i)
    fs::copy_file(folder_.path() / "m0.map", folder_.path() / ("m" + std::to_string(i) + ".map"));
  const std::size_t before = open_descriptors();
  open();
  for (const auto& [name, build] : catalog_->maps())
    EXPECT_EQ(get("/v1/maps/" + name).status, 200U);
  EXPECT_LE(open_descriptors() - before, 5U + 3U);
  EXPECT_EQ(catalog_->maps().size(), 40U);
}

// Until it holds, for ten seconds at most.
bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) std::this_thread::sleep_for(10ms);
  return condition();
}

class ReloaderTest : public ReloadTest {
 protected:
  ReloaderTest() { spdlog::set_level(spdlog::level::off); }

  void start(const ReloadSettings& settings) {
    open();
    current_ = std::make_shared<CurrentCatalog>(catalog_);
    reloader_.emplace(folder_.path(), current_, settings);
  }
  bool is_current(const std::string& build) const {
    const auto catalog = current_->now();
    const auto town = catalog->maps().find("town");
    return town != catalog->maps().end() && town->second->build == build;
  }

  std::shared_ptr<CurrentCatalog> current_;
  std::optional<Reloader> reloader_;
};

TEST_F(ReloaderTest, SeesFilesComeAndOldBuildsEnd) {
  settings_.keep = 300ms;
  const TownMap first = write(1);
  ReloadSettings settings;
  settings.quiet = 10ms;
  settings.interval = 1h;
  start(settings);
  const TownMap second = write(2);
  ASSERT_TRUE(comes_true([&] { return is_current(second.build); }));
  EXPECT_TRUE(comes_true([&] { return current_->now()->build("town", first.build) == nullptr; }));
  EXPECT_GE(reloader_->reloads(), 2U);
}

TEST_F(ReloaderTest, LooksWhenItIsAskedTo) {
  const TemporaryFolder elsewhere;
  write_town(elsewhere.path() / "first", 100, 1);
  const TownMap second = write_town(elsewhere.path() / "second", 100, 2);
  fs::create_symlink(elsewhere.path() / "first", folder_.path() / "town.map");
  ReloadSettings settings;
  settings.quiet = 1ms;
  settings.interval = 1h;
  start(settings);
  fs::rename(elsewhere.path() / "second", elsewhere.path() / "first");
  reloader_->look();
  EXPECT_TRUE(comes_true([&] { return is_current(second.build); }));
}

// A link's target is not watched, so that it tells which files were looked at.
TEST_F(ReloaderTest, AChangeCostsNoLookAtOtherFiles) {
  const TemporaryFolder elsewhere;
  const TownMap first = write_town(elsewhere.path() / "first", 100, 1);
  const TownMap second = write_town(elsewhere.path() / "second", 100, 2);
  fs::create_symlink(elsewhere.path() / "first", folder_.path() / "town.map");
  ReloadSettings settings;
  settings.quiet = 1ms;
  settings.interval = 1h;
  start(settings);
  write(3, "before.map");  // after which its first look at all is over
  ASSERT_TRUE(comes_true([&] { return current_->now()->maps().contains("before"); }));
  fs::rename(elsewhere.path() / "second", elsewhere.path() / "first");
  write(4, "village.map");
  ASSERT_TRUE(comes_true([&] { return current_->now()->maps().contains("village"); }));
  fs::remove(folder_.path() / "village.map");
  ASSERT_TRUE(comes_true([&] { return !current_->now()->maps().contains("village"); }));
  EXPECT_TRUE(is_current(first.build));
  reloader_->look();
  EXPECT_TRUE(comes_true([&] { return is_current(second.build); }));
}

TEST_F(ReloaderTest, SeesWhatIsNotWatchedFromTimeToTime) {
  write(1, ".first");
  const TownMap second = write(2, ".second");
  const TemporaryFolder elsewhere;
  fs::rename(folder_.path() / ".first", elsewhere.path() / "first");
  fs::rename(folder_.path() / ".second", elsewhere.path() / "second");
  fs::create_symlink(elsewhere.path() / "first", folder_.path() / "town.map");
  ReloadSettings settings;
  settings.interval = 20ms;
  start(settings);
  fs::rename(elsewhere.path() / "second", elsewhere.path() / "first");
  EXPECT_TRUE(comes_true([&] { return is_current(second.build); }));
}

TEST_F(ReloaderTest, ADirectoryThatIsGoneChangesNothing) {
  const TownMap town = write(1);
  start({});
  const TemporaryFolder elsewhere;
  fs::rename(folder_.path(), elsewhere.path() / "moved");
  ASSERT_TRUE(comes_true([&] { return reloader_->failures() > 0; }));
  EXPECT_TRUE(is_current(town.build));
  fs::rename(elsewhere.path() / "moved", folder_.path());
}

}  // namespace
}  // namespace milepost::server
