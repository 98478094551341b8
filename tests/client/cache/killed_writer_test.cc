// A process killed while it stores leaves a cache that another one can read.
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "client/cache/tile_cache.h"
#include "tests/client/cache/numbered_tile.h"
#include "tests/support/temp_folder.h"

extern char** environ;

namespace milepost::testing {
namespace {

// The writer as a child process, with its standard output.
class Writer {
 public:
  explicit Writer(const std::string& folder) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe(ends.data()), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    std::string program = MILEPOST_CACHE_WRITER;
    std::string argument = folder;
    std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
    EXPECT_EQ(posix_spawn(&child_, program.c_str(), &actions, nullptr, arguments.data(), environ),
              0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_ = fdopen(ends[0], "r");
  }

  // Reads lines until the one with `number`.
  bool wait_until_stored(unsigned number) {
    unsigned stored = 0;
    while (std::fscanf(output_, "%u", &stored) == 1) {
      if (stored == number) return true;
    }
    return false;
  }

  void kill_now() {
    kill(child_, SIGKILL);
    int status = 0;
    waitpid(child_, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    std::fclose(output_);
  }

 private:
  pid_t child_ = 0;
  std::FILE* output_ = nullptr;
};

std::unique_ptr<TileCache> open_cache(const std::filesystem::path& folder) {
  auto cache = TileCache::open({folder, 1ULL << 30U, [] { return std::int64_t{2}; }});
  EXPECT_TRUE(cache.ok());
  return std::move(cache).value();
}

TEST(KilledWriter, LeavesWholeTilesAndAWorkingCache) {
  const TempFolder folder;
  constexpr unsigned kRounds = 8;
  for (unsigned round = 0; round < kRounds; ++round) {
    SCOPED_TRACE(round);
    Writer writer(folder.path().string());
    const unsigned last = 10 + 7 * round;
    ASSERT_TRUE(writer.wait_until_stored(last));
    writer.kill_now();

    const auto cache = open_cache(folder.path());
    for (unsigned number = 0; number <= last; ++number) {
      EXPECT_EQ(cache->find(numbered_key(number)), numbered_content(number)) << number;
    }
    cache->store(numbered_key(1000000 + round), numbered_content(round));
    EXPECT_EQ(cache->find(numbered_key(1000000 + round)), numbered_content(round));
    EXPECT_EQ(cache->counters().failures, 0U);
    EXPECT_EQ(cache->counters().damaged_entries, 0U);
    EXPECT_EQ(cache->counters().damaged_files, 0U);
  }
}

TEST(KilledWriter, SharesTheCacheWhileItLives) {
  const TempFolder folder;
  Writer writer(folder.path().string());
  const auto cache = open_cache(folder.path());
  for (unsigned number = 0; number < 50; ++number) {
    ASSERT_TRUE(writer.wait_until_stored(number));
    EXPECT_EQ(cache->find(numbered_key(number)), numbered_content(number)) << number;
    cache->store(numbered_key(1000000 + number), numbered_content(number));
    EXPECT_EQ(cache->find(numbered_key(1000000 + number)), numbered_content(number));
  }
  EXPECT_EQ(cache->counters().failures, 0U);
  writer.kill_now();
}

}  // namespace
}  // namespace milepost::testing
