// Another process holds a lock that the cache needs. No wait may be unbounded, nor repeated at
// every frame: with a wait at each use these tests would take hours.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/client/cache/cache_test.h"

namespace milepost::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kManyFrames = 5000;
constexpr std::int64_t kLongEnough_s = 60;  // for the cache to try again

using LockedCacheTest = CacheTest;

// Holds the folder's lock as another process would: locks belong to open files, not to processes.
class HeldLock {
 public:
  explicit HeldLock(const fs::path& folder)
      : descriptor_(::open((folder / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    EXPECT_EQ(::flock(descriptor_, LOCK_EX), 0);
  }
  ~HeldLock() { ::close(descriptor_); }
  HeldLock(const HeldLock&) = delete;
  HeldLock& operator=(const HeldLock&) = delete;

 private:
  int descriptor_;
};

// Another connection to the cache's file, which runs `sql` and lives until the end of the scope.
class OtherConnection {
 public:
  OtherConnection(const fs::path& file, const std::string& sql) {
    EXPECT_EQ(sqlite3_open(file.c_str(), &database_), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database_);
  }
  ~OtherConnection() { sqlite3_close(database_); }
  OtherConnection(const OtherConnection&) = delete;
  OtherConnection& operator=(const OtherConnection&) = delete;

 private:
  sqlite3* database_ = nullptr;
};

TEST_F(LockedCacheTest, WithTheFoldersLockHeldTheVehicleGoesOnWithoutACache) {
  store_tiles(*open(), 0, 1);
  std::unique_ptr<TileCache> cache;
  {
    const HeldLock held(folder_.path());
    cache = open();
    for (int frame = 0; frame < kManyFrames; ++frame) {
      EXPECT_EQ(cache->find(numbered_key(0)), std::nullopt);
      cache->store(numbered_key(1), numbered_content(1));
    }
    EXPECT_GT(cache->counters().failures, 0U);
  }
  now_s_ += kLongEnough_s;
  EXPECT_TRUE(cache->find(numbered_key(0)).has_value());
  cache->store(numbered_key(1), numbered_content(1));
  EXPECT_EQ(cache->find(numbered_key(1)), numbered_content(1));
  EXPECT_EQ(cache->counters().damaged_files, 0U);
}

TEST_F(LockedCacheTest, WithTheFoldersLockHeldADamagedFileIsLeftForLater) {
  const auto cache = open();
  store_tiles(*cache, 0, 1);
  {
    const HeldLock held(folder_.path());
    change_database("DROP TABLE entries");
    for (int frame = 0; frame < kManyFrames; ++frame) cache->find(numbered_key(0));
  }
  now_s_ += kLongEnough_s;
  store_tiles(*cache, 0, 2);
  EXPECT_EQ(present(*cache, 2).size(), 2U);
}

TEST_F(LockedCacheTest, ALockThatIsAFifoOrAFolderStopsNobody) {
  ASSERT_EQ(::mkfifo((folder_ / "lock").c_str(), 0600), 0);
  store_tiles(*open(), 0, 1);
  fs::remove(folder_ / "lock");
  fs::create_directory(folder_ / "lock");
  const auto cache = open();
  for (int frame = 0; frame < kManyFrames; ++frame) cache->find(numbered_key(0));
  EXPECT_GT(cache->counters().failures, 0U);
  fs::remove(folder_ / "lock");
  now_s_ += kLongEnough_s;
  EXPECT_TRUE(cache->find(numbered_key(0)).has_value());
}

TEST_F(LockedCacheTest, WhileAnotherWritesTheCacheIsStillRead) {
  const auto cache = open();
  store_tiles(*cache, 0, 1);
  {
    const OtherConnection writer(folder_ / "tiles-1.sqlite", "BEGIN IMMEDIATE");
    for (int frame = 0; frame < kManyFrames; ++frame) {
      EXPECT_TRUE(cache->find(numbered_key(0)).has_value());
      cache->store(numbered_key(1), numbered_content(1));
    }
    EXPECT_TRUE(open()->find(numbered_key(0)).has_value());
    EXPECT_EQ(cache->find(numbered_key(1)), std::nullopt);
    EXPECT_GT(cache->counters().failures, 0U);
  }
  now_s_ += kLongEnough_s;
  cache->store(numbered_key(1), numbered_content(1));
  EXPECT_EQ(cache->find(numbered_key(1)), numbered_content(1));
}

TEST_F(LockedCacheTest, WhileAnotherHasTheFileToItselfTheVehicleGoesOnWithoutACache) {
  store_tiles(*open(), 0, 1);
  std::unique_ptr<TileCache> cache;
  {
    const OtherConnection alone(folder_ / "tiles-1.sqlite",
                                "PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE;"
                                "UPDATE entries SET number = number");
    cache = open();
    for (int frame = 0; frame < kManyFrames; ++frame) {
      EXPECT_EQ(cache->find(numbered_key(0)), std::nullopt);
      cache->touch(numbered_key(0));
    }
    EXPECT_GT(cache->counters().failures, 0U);
  }
  now_s_ += kLongEnough_s;
  EXPECT_TRUE(cache->find(numbered_key(0)).has_value());
}

}  // namespace
}  // namespace milepost::testing
