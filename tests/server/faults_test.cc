// Faults of the world, over real sockets and real files: maps that are replaced under load, and map
// files with flipped bits.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include <nlohmann/json.hpp>

#include "schema/store/sqlite.h"
#include "server/catalog/reloader.h"
#include "server/server.h"
#include "tests/server/connection.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr unsigned kReloads = 50;
constexpr int kRequestsOfThread = 25'000;
constexpr int kThreads = 4;

class UnderLoadTest : public ::testing::Test {
 protected:
  UnderLoadTest() {
    spdlog::set_level(spdlog::level::off);
    for (unsigned seed = 0; seed <= kReloads; ++seed) {
      TownMap town = write_town(waiting_.path() / std::to_string(seed), 200, seed + 1);
      frames_[town.build] = std::string(as_text(town.frames[2]));
    }
    show(0);
    const auto opened = Catalog::open(maps_.path(), CatalogSettings(), [](const std::string&) {});
    catalog_ = std::make_shared<CurrentCatalog>(*opened);
    ServerSettings settings;
    settings.threads = 2;
    server_ = std::move(Server::start(catalog_, settings)).value();
    ReloadSettings reload;
    reload.quiet = 1ms;
    reloader_.emplace(maps_.path(), catalog_, reload);
  }

  void show(unsigned seed) const {
    fs::rename(waiting_.path() / std::to_string(seed), maps_.path() / "town.map");
  }
  std::string build() const { return catalog_->now()->maps().at("town")->build; }

  // What the town's document names is there, and is that build's, whatever happens meanwhile.
  void drive(int requests) {
    Connection connection(server_->port());
    const auto get = [&](const std::string& target) {
      connection.send("GET " + target + " HTTP/1.1\r\nHost: h\r\n\r\n");
      return connection.receive();
    };
    std::string current;
    for (int i = 0; i < requests; ++i) {
      if (i % 50 == 0) {
        current = nlohmann::json::parse(get("/v1/maps/town").body).at("build");
        continue;
      }
      const Reply tile = get("/v1/maps/town/builds/" + current + "/segments/s1/tiles/tracklets/2");
      const bool is_right = tile.status == 200 && tile.body == frames_.at(current);
      if (!is_right) ++wrong_;
      ++answers_;
    }
  }

  TemporaryFolder waiting_;
  TemporaryFolder maps_;
  std::map<std::string, std::string> frames_;  // by build
  std::shared_ptr<CurrentCatalog> catalog_;
  std::unique_ptr<Server> server_;
  std::optional<Reloader> reloader_;
  std::atomic<int> answers_{0};
  std::atomic<int> wrong_{0};
};

TEST_F(UnderLoadTest, ReloadsFailNoRequestAndMixNoBuilds) {
  std::vector<std::thread> vehicles;
  for (int i = 0; i < kThreads; ++i) vehicles.emplace_back([this] { drive(kRequestsOfThread); });
  for (unsigned seed = 1; seed <= kReloads; ++seed) {
    const std::string before = build();
    show(seed);
    for (int i = 0; i < 10'000 && build() == before; ++i) std::this_thread::sleep_for(1ms);
    EXPECT_NE(build(), before);
  }
  for (std::thread& vehicle : vehicles) vehicle.join();
  EXPECT_GE(answers_, kThreads * kRequestsOfThread * 49 / 50);
  EXPECT_EQ(wrong_, 0);
  EXPECT_GE(reloader_->reloads(), kReloads);
}

// A small map in a file of small pages, so that most bits matter.
class FlippedBitsTest : public ::testing::TestWithParam<unsigned> {
 protected:
  FlippedBitsTest() : town_(write_town(file_, 20)) {
    auto database = sqlite::Database::open(file_, sqlite::Access::read_write);
    EXPECT_TRUE(database->execute("PRAGMA page_size = 512; VACUUM").ok());
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CLOEXEC);
    size_ = fs::file_size(file_);
  }
  ~FlippedBitsTest() override { ::close(descriptor_); }

  void flip(std::uintmax_t at, unsigned bit) const {
    unsigned char byte = 0;
    ASSERT_EQ(::pread(descriptor_, &byte, 1, static_cast<off_t>(at)), 1);
    byte ^= static_cast<unsigned char>(1U << bit);
    ASSERT_EQ(::pwrite(descriptor_, &byte, 1, static_cast<off_t>(at)), 1);
  }
  // Whether the file is served; then all that is sent is what the sound file has.
  bool serves_what_is_right() const {
    const auto held = std::make_shared<const HeldFile>(std::move(HeldFile::open(file_)).value());
    const auto map = ServedMap::open("town", held, 1, std::make_shared<MapFaults>());
    if (!map) return false;
    EXPECT_EQ((*map)->build(), town_.build);
    const auto& entries = (*map)->segments().at("s1").tiles.at("tracklets");
    for (const TileEntry& entry : entries) {
      const auto tile = (*map)->tile("s1", "tracklets", entry);
      EXPECT_TRUE(!tile || *tile == town_.frames[entry.index]);
    }
    const auto& cells = (*map)->cells().at("walls");
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto cell = (*map)->cell("walls", cells[i]);
      EXPECT_TRUE(!cell || *cell == town_.cells[i]);
    }
    return true;
  }

  TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "town.map";
  TownMap town_;
  int descriptor_ = -1;
  std::uintmax_t size_ = 0;
};

TEST_P(FlippedBitsTest, NothingWrongIsServed) {
  int served = 0;
  int refused = 0;
  for (std::uintmax_t at = 0; at < size_; ++at) {
    const unsigned bit = GetParam();
    flip(at, bit);
    ++(serves_what_is_right() ? served : refused);
    flip(at, bit);
    if (HasFailure()) FAIL() << "bit " << bit << " of byte " << at;
  }
  EXPECT_GT(served, 0);   // bits that nothing is in
  EXPECT_GT(refused, 0);  // and bits that the build covers
  EXPECT_TRUE(serves_what_is_right());
}

INSTANTIATE_TEST_SUITE_P(EachBit, FlippedBitsTest, ::testing::Range(0U, 8U));

}  // namespace
}  // namespace milepost::server
