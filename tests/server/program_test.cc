// The program itself, as an operator starts it.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/connection.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

// A running milepost-server, with its two outputs in pipes.
class Program {
 public:
  // `through`: a line of the shell that becomes the program, "$0" with "$@".
  explicit Program(std::vector<std::string> arguments, const std::string& through = "") {
    arguments.insert(arguments.begin(), MILEPOST_SERVER);
    if (!through.empty()) arguments.insert(arguments.begin(), {"/bin/sh", "-c", through});
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    std::array<int, 2> out{};
    std::array<int, 2> err{};
    if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0) abort();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    if (posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environ) != 0) abort();
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    close(err[1]);
    out_ = out[0];
    err_ = err[0];
  }

  ~Program() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    close(out_);
    close(err_);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // The next line of standard output; the rest if it ends.
  std::string line() {
    std::string text;
    for (char c = 0; ::read(out_, &c, 1) == 1 && c != '\n';) text += c;
    return text;
  }
  std::string output() { return rest_of(out_); }
  std::string error() { return rest_of(err_); }
  // Standard error up to the line that holds `text`, or to its end.
  std::string error_until(const std::string& text) {
    std::string lines;
    for (std::string line; line.find(text) == std::string::npos; lines += line) {
      line = error_lines(1);
      if (line.empty()) break;
    }
    return lines;
  }
  // The first `count` lines of standard error, or fewer if it ends.
  std::string error_lines(int count) {
    std::string text;
    for (char c = 0; count > 0 && ::read(err_, &c, 1) == 1; count -= c == '\n' ? 1 : 0) text += c;
    return text;
  }
  // The number of bytes that are available in standard error.
  int error_bytes() const {
    int bytes = 0;
    ioctl(err_, FIONREAD, &bytes);
    return bytes;
  }
  void signal(int number) const { kill(process_, number); }
  pid_t process() const { return process_; }

  // The exit code, or -1 if a signal ended the program, or -2 if it does not end.
  int wait() {
    int status = 0;
    for (int i = 0; i < 3000; ++i) {
      if (waitpid(process_, &status, WNOHANG) == process_) {
        process_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return -2;
  }

 private:
  static std::string rest_of(int pipe) {
    std::string text;
    std::array<char, 4096> bytes{};
    for (ssize_t n = 0; (n = ::read(pipe, bytes.data(), bytes.size())) > 0;) {
      text.append(bytes.data(), static_cast<std::size_t>(n));
    }
    return text;
  }

  pid_t process_ = 0;
  int out_ = -1;
  int err_ = -1;
};

// The port in "listening on 127.0.0.1:PORT (1 maps)".
std::uint16_t port_in(const std::string& line) {
  const std::size_t colon = line.rfind(':');
  return static_cast<std::uint16_t>(std::stoi(line.substr(colon + 1)));
}

TEST(ProgramTest, HelpTeaches) {
  Program program({"--help"});
  EXPECT_THAT(program.output(),
              AllOf(HasSubstr("--maps"), HasSubstr("--listen"), HasSubstr("--threads"),
                    HasSubstr("--config"), HasSubstr("Examples:"), HasSubstr("Exit codes:"),
                    HasSubstr("SIGHUP"), HasSubstr("town.map.bak"), HasSubstr("1 left out"),
                    HasSubstr("(1 to 256, default "), Not(HasSubstr("UINT"))));
  EXPECT_EQ(program.wait(), 0);
}

TEST(ProgramTest, VersionIsOneLine) {
  Program program({"--version"});
  EXPECT_THAT(program.output(), MatchesRegex("milepost-server [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_EQ(program.wait(), 0);
}

// One line on standard error and exit code 2.
void expect_wrong_call(const std::vector<std::string>& arguments, const std::string& what) {
  Program program(arguments);
  const std::string error = program.error();
  EXPECT_THAT(error, AllOf(StartsWith("milepost-server: "), HasSubstr(what), HasSubstr("--help")));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
  EXPECT_EQ(program.wait(), 2) << what;
}

TEST(ProgramTest, WrongCallsExitWith2) {
  expect_wrong_call({}, "--maps");
  expect_wrong_call({"--maps", "."}, "--listen");
  expect_wrong_call({"--maps", ".", "--listen", "127.0.0.1:0", "--colour"}, "--colour");
  expect_wrong_call({"--maps", ".", "--listen", "127.0.0.1:0", "stray"}, "stray");
  expect_wrong_call({"--maps", ".", "--listen", "127.0.0.1:0", "--threads", "0"}, "--threads");
  expect_wrong_call({"--maps", ".", "--listen", "127.0.0.1:0", "--threads", "two"}, "--threads");
  for (const char* listen : {"8080", "127.0.0.1", "127.0.0.1:", ":80", "127.0.0.1:65536", "::1:80",
                             "127.0.0.1:-1", "127.0.0.1:80x"}) {
    expect_wrong_call({"--maps", ".", "--listen", listen}, std::string("--listen ") + listen);
  }
  expect_wrong_call({"--config", "/nowhere/server.toml"}, "/nowhere/server.toml");
}

class ProgramWithMapTest : public ::testing::Test {
 protected:
  ProgramWithMapTest() { write_town(maps_.path() / "town.map"); }

  std::string config(const std::string& text) const {
    const auto file = other_.path() / "server.toml";
    std::ofstream(file) << text;
    return file;
  }

  TemporaryFolder maps_;
  TemporaryFolder other_;
};

TEST_F(ProgramWithMapTest, ServesUntilSigterm) {
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--threads", "2"});
  const std::string line = program.line();
  EXPECT_THAT(line, MatchesRegex("listening on 127\\.0\\.0\\.1:[0-9]+ \\(1 maps\\)"));
  EXPECT_THAT(fetch(port_in(line), "/v1/maps").body, HasSubstr("town"));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.error(), AllOf(HasSubstr("\"GET /v1/maps\" 200"), HasSubstr("SIGTERM")));
}

TEST_F(ProgramWithMapTest, StopsOnSigintWithAnOpenConnection) {
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0"});
  Connection idle(port_in(program.line()));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 0);
}

TEST_F(ProgramWithMapTest, ConfigurationFileHasTheOptionsAsKeys) {
  Program program({"--config", config("maps = \"" + maps_.path().string() +
                                      "\"\nlisten = \"127.0.0.1:0\"\nthreads = 1\n")});
  EXPECT_EQ(fetch(port_in(program.line()), "/healthz").status, 200);
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
}

TEST_F(ProgramWithMapTest, UnknownKeyIsAWrongCall) {
  expect_wrong_call(
      {"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--config", config("colour = \"red\"\n")},
      "colour");
  expect_wrong_call({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--config",
                     config("threads = \"many\"\n")},
                    "threads");
}

// One line on standard error and exit code 1.
void expect_failure(const std::vector<std::string>& arguments, const std::string& what) {
  Program program(arguments);
  EXPECT_EQ(program.output(), "");
  const std::string error = program.error();
  EXPECT_THAT(error, AllOf(StartsWith("milepost-server: "), HasSubstr(what), HasSubstr("; ")));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
  EXPECT_EQ(program.wait(), 1);
}

TEST_F(ProgramWithMapTest, WhatCannotBeServedExitsWith1) {
  expect_failure({"--maps", other_.path() / "none", "--listen", "127.0.0.1:0"},
                 "none: there is no such directory");
  expect_failure({"--maps", maps_.path(), "--listen", "192.0.2.1:0"},
                 "192.0.2.1:0: cannot be listened on");
  expect_failure({"--maps", maps_.path(), "--listen", "no.such.host.invalid:0"},
                 "address no.such.host.invalid: cannot be resolved");
  std::filesystem::resize_file(maps_.path() / "town.map", 4096);
  expect_failure({"--maps", maps_.path(), "--listen", "127.0.0.1:0"}, "town.map");
}

// The peak memory of a process so far.
long peak_kb(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stol(line.substr(6));
  }
  return -1;
}

TEST_F(ProgramWithMapTest, MemoryDoesNotGrowWithTheRange) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer keeps freed memory";
#endif
  constexpr long kTileKb = 16'000;
  const TownMap town = write_town(maps_.path() / "town.map", kTileKb * 1000);
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--threads", "1"});
  const std::uint16_t port = port_in(program.line());
  const std::string tiles = "/v1/maps/town/builds/" + town.build + "/segments/s1/tiles";
  EXPECT_EQ(fetch(port, tiles + "/tracklets/3").body.size(), town.frames[3].size());
  const long after_one_kb = peak_kb(program.process());
  EXPECT_TRUE(fetch(port, tiles + "?layer=tracklets&from_m=0&to_m=inf").whole);
  EXPECT_GT(after_one_kb, 0);
  EXPECT_LT(peak_kb(program.process()), after_one_kb + 3 * kTileKb / 2);  // all four: + 3
}

// Requests as many missing paths as fill a log of `bytes`.
void fill_log(std::uint16_t port, std::size_t bytes) {
  const std::string path = '/' + std::string(3000, 'x');
  Connection connection(port);
  for (std::size_t logged = 0; logged < bytes; logged += path.size()) {
    connection.send_get(path);
    ASSERT_EQ(connection.receive().status, 404);
  }
}

TEST_F(ProgramWithMapTest, LogThatNobodyReadsKeepsNothingFromAnAnswerNorFromTheStop) {
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--threads", "2"});
  const std::uint16_t port = port_in(program.line());
  ASSERT_NO_FATAL_FAILURE(fill_log(port, 4'000'000));
  EXPECT_GT(program.error_bytes(), 0);
  EXPECT_EQ(fetch(port, "/healthz").body, "ok\n");
  const auto told = std::chrono::steady_clock::now();
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - told, std::chrono::seconds(5));
}

TEST_F(ProgramWithMapTest, LogSaysHowManyLinesAreMissing) {
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--threads", "1"});
  const std::uint16_t port = port_in(program.line());
  constexpr int kRequests = 1000;
  ASSERT_NO_FATAL_FAILURE(fill_log(port, std::size_t{kRequests} * 3001));
  int written = 0;
  int missing = 0;
  while (written + missing < kRequests) {
    const std::string line = program.error_lines(1);
    ASSERT_NE(line, "") << written << " and " << missing;
    if (line.find("lines of the log are missing before this one") != std::string::npos) {
      missing += std::stoi(line.substr(std::string("milepost-server: ").size()));
    } else {
      ++written;
    }
  }
  EXPECT_EQ(written + missing, kRequests);
  EXPECT_GT(missing, 0);
  EXPECT_EQ(fetch(port, "/healthz").body, "ok\n");
  EXPECT_THAT(program.error_lines(1), HasSubstr("\"GET /healthz\" 200"));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
}

TEST_F(ProgramWithMapTest, LogIsWholeAfterAStop) {
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--threads", "1"});
  ASSERT_NO_FATAL_FAILURE(fill_log(port_in(program.line()), 30'000));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  const std::string error = program.error();
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 11);  // ten responses and the stop
  EXPECT_NE(error.find("stopping on SIGTERM\n"), std::string::npos);
}

// Kinds of unusable standard error; the server still serves and stops.
TEST_F(ProgramWithMapTest, LogThatCannotBeWrittenDoesNoHarm) {
  const std::string file = (other_.path() / "log").string();
  for (const std::string& through : {
           std::string("exec \"$0\" \"$@\" 2>&-"),
           std::string("exec \"$0\" \"$@\" 2>/dev/full"),
           "ulimit -f 1; exec \"$0\" \"$@\" 2>" + file,
           std::string("exec \"$0\" \"$@\" 2</dev/null"),
       }) {
    Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0"}, through);
    const std::uint16_t port = port_in(program.line());
    ASSERT_NO_FATAL_FAILURE(fill_log(port, 30'000)) << through;
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait(), 0) << through;
  }
}

// A socket with the descriptor of standard error would receive the log, too. (SQLite avoids these
// descriptors itself, so there is no map.)
TEST_F(ProgramWithMapTest, ClosedDescriptorsAreNotTakenByAnythingElse) {
  Program program({"--maps", other_.path(), "--listen", "127.0.0.1:0"},
                  "exec \"$0\" \"$@\" 0<&- 2>&-");
  EXPECT_EQ(fetch(port_in(program.line()), "/healthz").body, "ok\n");
  const std::filesystem::path open = "/proc/" + std::to_string(program.process()) + "/fd";
  EXPECT_EQ(std::filesystem::read_symlink(open / "0"), "/dev/null");
  EXPECT_EQ(std::filesystem::read_symlink(open / "2"), "/dev/null");
}

TEST_F(ProgramWithMapTest, MapsAreTakenUpWhenTheyComeAndOnSighup) {
  // Behind a link nothing is watched.
  const std::filesystem::path link = maps_.path() / "linked.map";
  write_town(other_.path() / "first.map", 100, 5);
  const std::string second = write_town(other_.path() / "second.map", 100, 6).build;
  std::filesystem::create_symlink(other_.path() / "first.map", link);
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0"});
  const std::uint16_t port = port_in(program.line());
  const std::string before = fetch(port, "/v1/maps").body;

  write_town(maps_.path() / "village.map", 100, 4);
  EXPECT_THAT(program.error_until("map village: is served now"), HasSubstr("GET /v1/maps"));
  EXPECT_EQ(fetch(port, "/v1/maps/village").status, 200);
  std::filesystem::rename(other_.path() / "second.map", other_.path() / "first.map");
  program.signal(SIGHUP);
  EXPECT_THAT(program.error_until("map linked: build " + second), HasSubstr("SIGHUP"));
  EXPECT_THAT(fetch(port, "/v1/maps").body, HasSubstr(second));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
}

TEST_F(ProgramWithMapTest, AMapThatIsDamagedLaterIsToldInTheLogAndAtReadyz) {
  const TownMap town = write_town(maps_.path() / "town.map", 5000);
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0"});
  const std::uint16_t port = port_in(program.line());
  EXPECT_EQ(fetch(port, "/readyz").body, "ok\n");
  std::filesystem::resize_file(maps_.path() / "town.map", 8192);
  const std::string tile = "/v1/maps/town/builds/" + town.build + "/segments/s1/tiles/tracklets/0";
  EXPECT_EQ(fetch(port, tile).status, 500);
  EXPECT_THAT(fetch(port, "/readyz").body, HasSubstr("of map town: "));
  EXPECT_THAT(fetch(port, "/metrics").body, HasSubstr("milepost_map_damaged{map=\"town\""));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.error(), HasSubstr("[error] " + (maps_.path() / "town.map").string()));
}

TEST_F(ProgramWithMapTest, CheckConfigListsWhatWouldBeServed) {
  Program sound({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--check-config"});
  EXPECT_THAT(sound.output(), AllOf(HasSubstr("town  build "), HasSubstr("town.map\n")));
  EXPECT_EQ(sound.error(), "");
  EXPECT_EQ(sound.wait(), 0);
  std::ofstream(maps_.path() / "half.map") << "";
  Program half({"--maps", maps_.path(), "--listen", "127.0.0.1:0", "--check-config"});
  EXPECT_THAT(half.output(), AllOf(HasSubstr("town  build "), HasSubstr("left out: "),
                                   HasSubstr("half.map: is empty")));
  EXPECT_THAT(half.error(),
              AllOf(HasSubstr("1 of its maps would be left out"), Not(HasSubstr("\nmilepost"))));
  EXPECT_EQ(half.wait(), 1);
}

TEST_F(ProgramWithMapTest, RestIsServedAndTheFirstLineCounts) {
  std::ofstream(maps_.path() / "half.map") << "";
  std::ofstream(maps_.path() / "README") << "text";
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0"});
  const std::string line = program.line();
  EXPECT_THAT(line, HasSubstr(" (1 maps, 1 left out)"));
  EXPECT_EQ(fetch(port_in(line), "/v1/maps/town").status, 200);
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.error(), HasSubstr("half.map: is empty; "));
}

TEST_F(ProgramWithMapTest, NothingButBadMapsExitsWith1AndEachReason) {
  std::filesystem::resize_file(maps_.path() / "town.map", 4096);
  std::ofstream(maps_.path() / "half.map") << "";
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0"});
  EXPECT_EQ(program.output(), "");
  const std::string error = program.error();
  EXPECT_THAT(error, AllOf(HasSubstr("half.map: is empty"), HasSubstr("town.map: is truncated"),
                           HasSubstr("\nmilepost-server: " + maps_.path().string() +
                                     ": none of its 2 maps can be served; ")));
  EXPECT_EQ(program.wait(), 1);
}

TEST_F(ProgramWithMapTest, DirectoryWithoutMapsIsServed) {
  Program program({"--maps", other_.path(), "--listen", "127.0.0.1:0"});
  EXPECT_THAT(program.line(), HasSubstr(" (0 maps)"));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
}

TEST_F(ProgramWithMapTest, OtherFilesAreNamedInTheLog) {
  std::ofstream(maps_.path() / "README") << "text";
  Program program({"--maps", maps_.path(), "--listen", "127.0.0.1:0"});
  EXPECT_THAT(program.line(), HasSubstr("(1 maps)"));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.error(), HasSubstr("README: is not a milepost map and is skipped"));
}

}  // namespace
}  // namespace milepost::server
