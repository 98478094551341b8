// Many clients at once, against the program in a process of its own.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "schema/geo/route_line.h"
#include "tests/server/connection.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using namespace std::chrono_literals;

// A server that a shell starts, after `before`; its log is dropped.
class Process {
 public:
  explicit Process(const std::filesystem::path& maps, const std::string& before = "") {
    std::string command = before +
                          "exec " MILEPOST_SERVER " --listen 127.0.0.1:0 --threads 2 --maps " +
                          maps.string() + " 2>/dev/null";
    std::string shell = "/bin/sh";
    std::string option = "-c";
    std::array<char*, 4> argv = {shell.data(), option.data(), command.data(), nullptr};
    std::array<int, 2> out{};
    if (pipe2(out.data(), O_CLOEXEC) != 0) abort();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    if (posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environ) != 0) abort();
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    std::string line;  // "listening on 127.0.0.1:PORT (1 maps)"
    for (char c = 0; ::read(out[0], &c, 1) == 1 && c != '\n';) line += c;
    close(out[0]);
    port_ = static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(':') + 1)));
  }
  ~Process() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  std::uint16_t port() const { return port_; }
  // A value of /proc/PID/status in kB, such as the peak "VmHWM".
  long memory_kb(const std::string& name) const {
    std::ifstream status("/proc/" + std::to_string(process_) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with(name + ':')) return std::stol(line.substr(name.size() + 1));
    }
    return -1;
  }

 private:
  pid_t process_ = 0;
  std::uint16_t port_ = 0;
};

constexpr std::uint32_t kTiles = 500;
constexpr std::size_t kTileBytes = 100'000;

// A segment with a range of 50 MB. Returns the target of the range.
std::string write_long_range(const std::filesystem::path& file) {
  auto writer = MapWriter::create(file);
  const auto line = RouteLine::from_vertices({{49, 8, 110}, {49.3, 8, 110}});
  bool good =
      writer.ok() && writer->set_feature_json("{}").ok() &&
      writer->add_layer("tracklets", "{}").ok() &&
      writer
          ->add_segment(
              {"s1", line->length_m(), {{49, 8, 110, 0}, {49.3, 8, 110, line->length_m()}}, {}})
          .ok();
  for (std::uint32_t i = 0; i < kTiles && good; ++i) {
    Bytes bytes(kTileBytes, static_cast<std::uint8_t>(i));
    bytes[0] = static_cast<std::uint8_t>(i >> 8U);  // so that no two are equal
    good = writer->add_tile("s1", "tracklets", i, {50.0 * i, 50.0 * (i + 1)}, 1, bytes).ok();
  }
  const auto build = writer->finish();
  EXPECT_TRUE(good && build.ok());
  return "/v1/maps/long/builds/" + *build + "/segments/s1/tiles?layer=tracklets&from_m=0&to_m=inf";
}

bool can_open(rlim_t descriptors) {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  return setrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_max >= descriptors;
}

TEST(LoadTest, SlowReadersOfLongRangesTakeLittleMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer needs memory of its own";
#endif
  const TemporaryFolder folder;
  const std::string target = write_long_range(folder.path() / "long.map");
  const Process server(folder.path());
  std::vector<std::unique_ptr<Connection>> readers;
  for (std::size_t i = 0; i < 200; ++i) {
    readers.push_back(std::make_unique<Connection>(server.port(), 4096));
    readers.back()->send_get(target);
  }
  // They are at different places of the range.
  for (std::size_t i = 0; i < readers.size(); ++i) {
    EXPECT_EQ(readers[i]->read(1000 + i * 2'000).size(), 1000 + i * 2'000);
  }
  EXPECT_EQ(fetch(server.port(), target).body.size(), kTiles * kTileBytes);
  EXPECT_EQ(fetch(server.port(), "/healthz").status, 200);
  EXPECT_LT(server.memory_kb("VmHWM"), 150'000);
}

TEST(LoadTest, TenThousandIdleConnectionsAreKept) {
  constexpr std::size_t kConnections = 10'000;
  if (!can_open(kConnections / 3 * 4 + 1000)) GTEST_SKIP() << "too few descriptors are allowed";
  const TemporaryFolder folder;
  write_town(folder.path() / "town.map");
  const Process server(folder.path());
  std::vector<std::unique_ptr<Connection>> idle;
  for (std::size_t i = 0; i < kConnections; ++i) {
    // No address may have more than half of all.
    const std::string source = "127.0.0." + std::to_string(1 + i % 8);
    idle.push_back(std::make_unique<Connection>(server.port(), source.c_str()));
  }
  EXPECT_EQ(fetch(server.port(), "/healthz").status, 200);
  for (std::size_t i = 0; i < idle.size(); i += 100) {
    idle[i]->send_get("/v1/maps");
    ASSERT_EQ(idle[i]->receive().status, 200) << i;
  }
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // whose own memory grows, too
  EXPECT_LT(server.memory_kb("VmRSS"), 100'000);
#endif
}

TEST(LoadTest, FewDescriptorsAreEnough) {
  const TemporaryFolder folder;
  write_town(folder.path() / "town.map");
  const Process server(folder.path(), "ulimit -n 64; ");
  std::vector<std::unique_ptr<Connection>> silent;
  for (int i = 0; i < 300; ++i) {
    const std::string source = "127.0.0." + std::to_string(1 + i % 8);
    silent.push_back(std::make_unique<Connection>(server.port(), source.c_str()));
  }
  for (int i = 0; i < 10; ++i) EXPECT_EQ(fetch(server.port(), "/v1/maps/town").status, 200);
}

}  // namespace
}  // namespace milepost::server
