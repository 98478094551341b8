// Builds that are installed, kept, and rolled back to.
#include "server/catalog/build_store.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include <nlohmann/json.hpp>

#include "schema/base/file.h"
#include "server/catalog/signature_file.h"
#include "server/routes/handle.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BuildStoreTest : public ::testing::Test {
 protected:
  // Writes a new file of the town elsewhere and installs it.
  TownMap install(unsigned seed, std::size_t keep = 3) {
    const TownMap town = write_town(incoming_, 100, seed);
    const auto build = store_.install(incoming_, keep);
    EXPECT_TRUE(build.ok()) << build.error().line();
    return town;
  }
  std::string current() const {
    const auto reader = MapReader::open(maps_.path() / "town.map");
    return reader ? reader->build() : reader.error().line();
  }
  std::vector<std::string> kept() const {
    std::vector<std::string> builds;
    for (const KeptBuild& each : store_.kept("town")) builds.push_back(each.build);
    return builds;
  }
  // Names in the directory, also hidden ones.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(maps_.path()))
      names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }

  TemporaryFolder maps_;
  TemporaryFolder elsewhere_;
  const fs::path incoming_ = elsewhere_.path() / "town.map";
  BuildStore store_{maps_.path()};
};

TEST_F(BuildStoreTest, TheBuildBeforeIsKeptAndComesBack) {
  const TownMap first = install(1);
  EXPECT_THAT(kept(), IsEmpty());
  const TownMap second = install(2);
  EXPECT_EQ(current(), second.build);
  EXPECT_THAT(kept(), ElementsAre(first.build));
  EXPECT_EQ(*store_.roll_back("town", ""), first.build);
  EXPECT_EQ(current(), first.build);
  EXPECT_EQ(*store_.roll_back("town", ""), second.build);  // and forward again
  EXPECT_EQ(current(), second.build);
  EXPECT_EQ(*store_.roll_back("town", first.build), first.build);
  EXPECT_THAT(names(), ElementsAre(".builds", "town.map"));
}

TEST_F(BuildStoreTest, AsManyAreKeptAsAreAskedFor) {
  const TownMap first = install(1, 2);
  const TownMap second = install(2, 2);
  const TownMap third = install(3, 2);
  const TownMap fourth = install(4, 2);
  EXPECT_THAT(kept(), ElementsAre(third.build, second.build));
  const auto gone = store_.roll_back("town", first.build);
  ASSERT_FALSE(gone.ok());
  EXPECT_THAT(gone.error().line(), HasSubstr("does not keep build " + first.build));
  EXPECT_EQ(current(), fourth.build);
}

TEST_F(BuildStoreTest, WhatIsDamagedTakesNoPlace) {
  const TownMap first = install(1);
  const TownMap second = write_town(incoming_, 100, 2);
  std::string bytes = *read_text_file(incoming_);
  bytes[bytes.find(as_text(second.frames[1])) + 50] ^= 1;
  std::ofstream(incoming_, std::ios::binary) << bytes;
  const auto refused = store_.install(incoming_, 3);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().line(), HasSubstr(incoming_.string()));
  EXPECT_EQ(current(), first.build);
  EXPECT_THAT(names(), ElementsAre("town.map"));
  // Nor does a kept build that was damaged meanwhile.
  install(3);
  fs::resize_file(store_.kept("town").front().file, 4096);
  EXPECT_FALSE(store_.roll_back("town", "").ok());
}

TEST_F(BuildStoreTest, TheCurrentBuildIsNotInstalledTwice) {
  install(1);
  const auto again = store_.install(incoming_, 3);
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(again.error().line(), HasSubstr("is the current one of map 'town' already"));
  EXPECT_THAT(names(), ElementsAre("town.map"));
}

TEST_F(BuildStoreTest, ASignatureGoesWithItsMap) {
  write_town(incoming_, 100, 1);
  std::ofstream(signature_file_of(incoming_)) << "first";
  ASSERT_TRUE(store_.install(incoming_, 3).ok());
  write_town(incoming_, 100, 2);
  std::ofstream(signature_file_of(incoming_)) << "second";
  ASSERT_TRUE(store_.install(incoming_, 3).ok());
  const auto text = [&] {
    std::ifstream file(maps_.path() / "town.map.sig");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(text(), "second");
  ASSERT_TRUE(store_.roll_back("town", "").ok());
  EXPECT_EQ(text(), "first");
}

TEST_F(BuildStoreTest, AFullDiskLeavesTheCurrentBuild) {
  const TownMap first = install(1);
  write_town(incoming_, 100'000, 2);
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100'000, 100'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto installed = store_.install(incoming_, 3);
    const bool is_told = !installed && installed.error().line().find(
                                           "town.map: cannot be written") != std::string::npos;
    _exit(is_told ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(current(), first.build);
  EXPECT_THAT(names(), ElementsAre("town.map"));
}

class ChangesTest : public BuildStoreTest {
 protected:
  json changes(const std::string& from) {
    const auto catalog = open_catalog(maps_.path());
    const Response response = handle({"GET", "/v1/maps/town/changes?from=" + from, ""}, *catalog);
    EXPECT_EQ(response.status, 200U) << text_of(response);
    EXPECT_EQ(response.header("Cache-Control"), "no-cache");
    return json::parse(text_of(response));
  }
};

TEST_F(ChangesTest, NothingDiffersFromTheCurrentBuild) {
  const TownMap town = install(1);
  EXPECT_EQ(changes(town.build), json({{"map", "town"},
                                       {"from", town.build},
                                       {"to", town.build},
                                       {"segments", json::array()},
                                       {"bytes", 0}}));
}

TEST_F(ChangesTest, EachTileThatDiffersIsListedAndNoOther) {
  const TownMap town = install(1);
  write_changed_town(incoming_, town);
  ASSERT_TRUE(store_.install(incoming_, 3).ok());
  const json all = changes(town.build);
  EXPECT_EQ(all.at("from"), town.build);
  EXPECT_EQ(all.at("to"), current());
  EXPECT_TRUE(all.contains("document"));  // its length differs
  EXPECT_FALSE(all.contains("areas"));
  const json& segments = all.at("segments");
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].at("segment"), "s1");
  EXPECT_EQ(segments[0].at("change"), "changed");
  const json& tracklets = segments[0].at("tiles").at("tracklets");
  ASSERT_EQ(tracklets.at("changed").size(), 1U);
  EXPECT_EQ(tracklets.at("changed")[0].at("index"), 1);
  EXPECT_EQ(tracklets.at("removed"), json({3}));
  EXPECT_EQ(segments[1], json({{"segment", "s2"}, {"change", "removed"}}));
  EXPECT_EQ(all.at("bytes"), all.at("document").at("bytes").get<int>() +
                                 segments[0].at("bytes").get<int>() +
                                 tracklets.at("changed")[0].at("bytes").get<int>());
}

TEST_F(ChangesTest, BuildsThatAreNotKeptAreGone) {
  const TownMap first = install(1, 0);
  install(2, 0);
  const auto catalog = open_catalog(maps_.path());
  const auto status = [&](const std::string& target) {
    return handle({"GET", target, ""}, *catalog).status;
  };
  EXPECT_EQ(status("/v1/maps/town/changes?from=" + first.build), 410U);
  EXPECT_EQ(status("/v1/maps/town/changes?from=../../town"), 400U);
  EXPECT_EQ(status("/v1/maps/town/changes"), 400U);
  EXPECT_EQ(status("/v1/maps/village/changes?from=" + first.build), 404U);
}

}  // namespace
}  // namespace milepost::server
