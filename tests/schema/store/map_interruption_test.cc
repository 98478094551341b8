// A writer that is killed or runs out of disk space, in its own process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "schema/base/file.h"
#include "schema/store/map_store.h"
#include "tests/schema/store/example_map.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFrameBytes = 100'000;

class MapInterruptionTest : public ::testing::Test {
 protected:
  // The file at the map's path must be the complete old map.
  void expect_old_map() const {
    EXPECT_EQ(testing::content_of(file_), old_content_);
    const auto reader = MapReader::open(file_);
    ASSERT_TRUE(reader.ok()) << reader.error().line();
    EXPECT_TRUE(reader->verify().ok());
  }

  testing::TempFolder folder_;
  fs::path file_ = folder_ / "town.map";
  std::string build_ = testing::write_example(file_);
  std::string old_content_ = testing::content_of(file_);
};

// Runs `body` in a child process and returns its number.
pid_t start(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  return child;
}

int status_of(pid_t child) {
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return status;
}

// Adds tiles until one fails or there are `count`.
Status add_tiles(MapWriter& writer, std::uint32_t count) {
  Status status = writer.add_layer("tracklets", "{}");
  if (status.ok()) status = writer.add_segment({"s", 1000, testing::kShortLine, {}});
  for (std::uint32_t i = 0; i < count && status.ok(); ++i) {
    status = writer.add_tile("s", "tracklets", i, {1.0 * i, 2.0 * i}, 1,
                             testing::tile_bytes(kFrameBytes, i));
  }
  return status;
}

TEST_F(MapInterruptionTest, KilledItLeavesTheOldMapWhole) {
  for (const std::uint32_t tiles : {0U, 1U, 30U, 200U}) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = start([&] {
      Result<MapWriter> writer = MapWriter::create(file_);
      if (!writer.ok() || !add_tiles(*writer, tiles).ok()) return 1;
      const char byte = 1;
      if (write(ready[1], &byte, 1) != 1) return 1;
      while (true) pause();
    });
    close(ready[1]);
    char byte = 0;
    EXPECT_EQ(read(ready[0], &byte, 1), 1);  // the writer has started
    close(ready[0]);
    kill(child, SIGKILL);
    EXPECT_TRUE(WIFSIGNALED(status_of(child)));
    expect_old_map();
  }
  testing::write_example(file_);  // and leftovers do not disturb a later writer
  expect_old_map();
}

// Killed repeatedly at some instant of writing and publishing: either the old map or the new one.
TEST_F(MapInterruptionTest, KilledAtAnyInstantThereIsAWholeMap) {
  for (int delay_us = 0; delay_us < 60'000; delay_us += 3000) {
    const pid_t child = start([&] {
      while (true) {
        Result<MapWriter> writer = MapWriter::create(file_);
        if (!writer.ok() || !add_tiles(*writer, 5).ok() || !writer->finish().ok()) return 1;
      }
    });
    usleep(delay_us);
    kill(child, SIGKILL);
    EXPECT_TRUE(WIFSIGNALED(status_of(child)));
    const auto reader = MapReader::open(file_);
    ASSERT_TRUE(reader.ok()) << reader.error().line();
    EXPECT_TRUE(reader->verify().ok());
  }
}

// A limit on the size of files simulates a full disk.
TEST_F(MapInterruptionTest, AFullDiskIsAnErrorThatNamesTheFile) {
  for (const rlim_t limit : {1000U, 500'000U, 20'000'000U}) {
    const pid_t child = start([&] {
      signal(SIGXFSZ, SIG_IGN);
      const rlimit size{limit, limit};
      if (setrlimit(RLIMIT_FSIZE, &size) != 0) return 1;
      Result<MapWriter> writer = MapWriter::create(file_);
      Status status = writer.ok() ? add_tiles(*writer, 220) : Status(writer.error());
      if (status.ok()) {
        const auto build = writer->finish();
        if (!build.ok()) status = build.error();
      }
      if (status.ok()) return 2;
      if (status.error().code != ErrorCode::io) return 3;
      if (status.error().where != file_.string()) return 4;
      return 0;
    });
    const int status = status_of(child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0) << "limit " << limit;
    expect_old_map();
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
  }
}

}  // namespace
}  // namespace milepost
