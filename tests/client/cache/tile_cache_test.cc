#include "client/cache/tile_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "schema/base/digest.h"
#include "tests/client/cache/cache_test.h"

namespace milepost::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

using TileCacheTest = CacheTest;

TEST_F(TileCacheTest, KeepsWhatWasStored) {
  open()->store(numbered_key(7), numbered_content(7));
  const auto cache = open();
  EXPECT_EQ(cache->find(numbered_key(7)), numbered_content(7));
  EXPECT_EQ(cache->find(numbered_key(7), digest_of(numbered_content(7))), numbered_content(7));
  EXPECT_EQ(cache->find(numbered_key(8)), std::nullopt);
}

TEST_F(TileCacheTest, EveryPartOfTheKeyCounts) {
  const auto cache = open();
  cache->store({"m", "b", "s", "l", 1}, as_bytes("x"));
  EXPECT_EQ(text_of(cache->find({"m", "b", "s", "l", 1})), "x");
  for (const CacheKey& other : {CacheKey{"M", "b", "s", "l", 1}, CacheKey{"m", "B", "s", "l", 1},
                                CacheKey{"m", "b", "S", "l", 1}, CacheKey{"m", "b", "s", "L", 1},
                                CacheKey{"m", "b", "s", "l", 2}}) {
    EXPECT_EQ(cache->find(other), std::nullopt);
  }
}

TEST_F(TileCacheTest, WhatANewBuildHasInCommonWithTheOneBeforeIsFoundByItsDigest) {
  const auto cache = open();
  const Bytes content = numbered_content(7);
  const std::string digest = digest_of(content);
  cache->store({"m", "b1", "s", "l", 7}, content);
  EXPECT_EQ(cache->find({"m", "b2", "s", "l", 7}), std::nullopt);  // of which nothing is known
  EXPECT_EQ(cache->find({"m", "b2", "s", "l", 7}, digest_of(as_bytes("x"))), std::nullopt);
  for (const CacheKey& other : {CacheKey{"M", "b2", "s", "l", 7}, CacheKey{"m", "b2", "S", "l", 7},
                                CacheKey{"m", "b2", "s", "L", 7}, CacheKey{"m", "b2", "s", "l", 8}})
    EXPECT_EQ(cache->find(other, digest), std::nullopt);
  EXPECT_EQ(cache->find({"m", "b2", "s", "l", 7}, digest), content);
  EXPECT_EQ(cache->find({"m", "b2", "s", "l", 7}), content);
  EXPECT_EQ(cache->find({"m", "b1", "s", "l", 7}), std::nullopt);     // it moved
  EXPECT_EQ(cache->find({"m", "b1", "s", "l", 7}, digest), content);  // and back
  EXPECT_EQ(cache->bytes(), content.size());
}

TEST_F(TileCacheTest, StoringAgainReplaces) {
  const auto cache = open();
  cache->store(numbered_key(1), as_bytes("old content"));
  cache->store(numbered_key(1), as_bytes("new"));
  EXPECT_EQ(text_of(cache->find(numbered_key(1))), "new");
  EXPECT_EQ(cache->bytes(), 3U);
  cache->remove(numbered_key(1));
  EXPECT_EQ(cache->find(numbered_key(1)), std::nullopt);
  EXPECT_EQ(cache->bytes(), 0U);
}

TEST_F(TileCacheTest, TheLeastRecentlyUsedGoesFirst) {
  const auto cache = open(300);
  for (std::uint32_t number = 0; number < 3; ++number) {
    ++now_s_;
    cache->store(numbered_key(number), bytes_of_size(100, 1));
  }
  ++now_s_;
  EXPECT_TRUE(cache->find(numbered_key(0)).has_value());  // 1 is the least recently used now
  ++now_s_;
  cache->touch(numbered_key(1));  // and now 2 is
  ++now_s_;
  cache->store(numbered_key(3), bytes_of_size(100, 1));
  EXPECT_THAT(present(*cache, 4), ElementsAre(0, 1, 3));
}

TEST_F(TileCacheTest, ADocumentOutlivesTheTilesItLeadsTo) {
  const auto cache = open(200);
  const CacheKey document = CacheKey::segment_document("town", "build", "s1");
  cache->store(document, bytes_of_size(100, 1));
  cache->store(numbered_key(1), bytes_of_size(100, 1));
  ++now_s_;
  cache->store(numbered_key(2), bytes_of_size(100, 1));
  EXPECT_TRUE(cache->find(document).has_value());
  EXPECT_THAT(present(*cache, 3), ElementsAre(2));
}

TEST_F(TileCacheTest, NeverHoldsMoreThanItsLimit) {
  const auto cache = open(1000);
  for (std::uint32_t number = 0; number < 50; ++number) {
    ++now_s_;
    cache->store(numbered_key(number), bytes_of_size(90 + number, 1));
    EXPECT_LE(cache->bytes(), 1000U);
  }
  EXPECT_TRUE(cache->find(numbered_key(49)).has_value());
  EXPECT_GT(cache->bytes(), 700U);
}

TEST_F(TileCacheTest, WhatIsLargerThanTheLimitIsNotStoredAndPushesNothingOut) {
  const auto cache = open(100);
  cache->store(numbered_key(0), bytes_of_size(100, 1));
  cache->store(numbered_key(1), bytes_of_size(101, 1));
  EXPECT_THAT(present(*cache, 2), ElementsAre(0));
}

TEST_F(TileCacheTest, ASmallerLimitHoldsFromTheStart) {
  for (std::uint32_t number = 0; number < 4; ++number) {
    ++now_s_;
    open()->store(numbered_key(number), bytes_of_size(100, 1));
  }
  EXPECT_THAT(present(*open(250), 4), ElementsAre(2, 3));
}

TEST_F(TileCacheTest, AChangedByteIsFoundAndTheEntryDropped) {
  open()->store(numbered_key(1), as_bytes("good"));
  change_database("UPDATE entries SET content = x'626164'");
  const auto cache = open();
  EXPECT_EQ(cache->find(numbered_key(1)), std::nullopt);
  EXPECT_EQ(cache->counters().damaged_entries, 1U);
  EXPECT_EQ(cache->bytes(), 0U);
}

TEST_F(TileCacheTest, AnotherDigestThanTheExpectedOneIsNotHandedOut) {
  const auto cache = open();
  cache->store(numbered_key(1), as_bytes("one"));
  EXPECT_EQ(cache->find(numbered_key(1), digest_of(as_bytes("another"))), std::nullopt);
}

TEST_F(TileCacheTest, AFileThatIsNoDatabaseIsSetAside) {
  std::ofstream(folder_ / "tiles-1.sqlite") << std::string(10000, 'x');
  const auto cache = open();
  cache->store(numbered_key(1), as_bytes("new"));
  EXPECT_EQ(text_of(open()->find(numbered_key(1))), "new");
  EXPECT_TRUE(fs::exists(folder_ / "tiles-1.sqlite.damaged"));
  EXPECT_FALSE(fs::exists(folder_ / "tiles-1.sqlite"));
}

TEST_F(TileCacheTest, ACacheOfAnotherLayoutIsSetAside) {
  open()->store(numbered_key(1), as_bytes("theirs"));
  change_database("PRAGMA user_version = 3");
  const auto cache = open();
  EXPECT_EQ(cache->find(numbered_key(1)), std::nullopt);
  cache->store(numbered_key(1), as_bytes("ours"));
  EXPECT_EQ(text_of(cache->find(numbered_key(1))), "ours");
  EXPECT_TRUE(fs::exists(folder_ / "tiles-1.sqlite.damaged"));
}

// Overwrites the file from `offset` to its end while a cache has it open or not.
void spoil(const fs::path& file, std::uintmax_t offset) {
  const std::uintmax_t size = fs::file_size(file);
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(offset));
  stream << std::string(size - offset, '\x5a');
}

TEST_F(TileCacheTest, DamageAnywhereInTheFileIsSurvived) {
  for (std::uint32_t page = 1; page < 12; ++page) {
    SCOPED_TRACE(page);
    const TempFolder folder;
    const CacheSettings settings{folder.path(), kPlenty, [] { return std::int64_t{1}; }};
    {
      const auto cache = std::move(TileCache::open(settings)).value();
      for (std::uint32_t i = 0; i < 4; ++i) cache->store(numbered_key(i), numbered_content(i));
    }
    spoil(folder / "tiles-1.sqlite", page * 4096U);
    const auto cache = std::move(TileCache::open(settings)).value();
    for (std::uint32_t i = 0; i < 4; ++i) {
      const auto found = cache->find(numbered_key(i));
      EXPECT_TRUE(!found.has_value() || found == numbered_content(i)) << i;
    }
    for (std::uint32_t i = 0; i < 20; ++i) cache->store(numbered_key(i), numbered_content(i));
    cache->store(numbered_key(100), as_bytes("after"));
    EXPECT_EQ(text_of(cache->find(numbered_key(100))), "after");
  }
}

TEST_F(TileCacheTest, AllWhoShareADamagedFileMoveOnToTheSameNewOne) {
  const auto first = open();
  const auto second = open();
  first->store(numbered_key(1), numbered_content(1));
  change_database("DROP TABLE total");
  first->store(numbered_key(2), numbered_content(2));   // detects the damage, replaces the file
  second->store(numbered_key(2), numbered_content(2));  // detects the damage, finds the new file
  first->store(numbered_key(3), numbered_content(3));
  second->store(numbered_key(4), numbered_content(4));
  EXPECT_THAT(present(*first, 5), ElementsAre(3, 4));
  EXPECT_THAT(present(*second, 5), ElementsAre(3, 4));
  EXPECT_EQ(first->counters().damaged_files, 1U);
  EXPECT_EQ(second->counters().damaged_files, 1U);
  EXPECT_TRUE(fs::exists(folder_ / "tiles-2.sqlite"));
  EXPECT_FALSE(fs::exists(folder_ / "tiles-3.sqlite"));
}

TEST_F(TileCacheTest, SeveralThreadsShareOneCache) {
  const auto cache = open();
  std::vector<std::thread> threads;
  for (std::uint32_t first = 0; first < 4; ++first) {
    threads.emplace_back([&, first] {
      for (std::uint32_t number = first; number < 60; number += 4) {
        cache->store(numbered_key(number), numbered_content(number));
        EXPECT_EQ(cache->find(numbered_key(number)), numbered_content(number));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(present(*cache, 60).size(), 60U);
}

TEST_F(TileCacheTest, SeveralConnectionsShareOneFile) {
  std::vector<std::thread> threads;
  for (std::uint32_t first = 0; first < 3; ++first) {
    threads.emplace_back([&, first] {
      const auto cache = open();
      for (std::uint32_t number = first; number < 60; number += 3) {
        cache->store(numbered_key(number), numbered_content(number));
      }
      EXPECT_EQ(cache->counters().failures, 0U);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(present(*open(), 60).size(), 60U);
}

TEST_F(TileCacheTest, DocumentsOfTheBuildUsedLastAreListed) {
  const auto cache = open();
  cache->store(CacheKey::segment_document("town", "build 2", "s1"), as_bytes("new s1"));
  ++now_s_;
  cache->store(CacheKey::segment_document("town", "build 1", "s1"), as_bytes("old s1"));
  cache->store(CacheKey::segment_document("village", "only", "s1"), as_bytes("village s1"));
  cache->store(CacheKey::map_document("town", "build 2"), as_bytes("the map itself"));
  ++now_s_;
  cache->touch(CacheKey::segment_document("town", "build 2", "s1"));
  cache->store(CacheKey::segment_document("town", "build 2", "s2"), as_bytes("new s2"));
  std::vector<std::string> contents;
  for (const CachedDocument& document : cache->segment_documents()) {
    contents.push_back(document.content);
  }
  EXPECT_THAT(contents, ::testing::UnorderedElementsAre("new s1", "new s2", "village s1"));
}

TEST_F(TileCacheTest, MapDocumentsOfTheBuildUsedLastAreListed) {
  const auto cache = open();
  cache->store(CacheKey::map_document("village", "only"), as_bytes("village"));
  cache->store(CacheKey::map_document("town", "build 2"), as_bytes("new"));
  ++now_s_;
  cache->store(CacheKey::map_document("town", "build 1"), as_bytes("old"));
  ++now_s_;
  cache->store(CacheKey::areas_document("town", "build 1"), as_bytes("the old cells"));
  cache->store(CacheKey::segment_document("town", "build 1", "s1"), as_bytes("old s1"));
  cache->store({"town", "build 1", "", "walls", 0}, as_bytes("a cell"));
  cache->touch(CacheKey::map_document("town", "build 2"));
  std::vector<std::string> contents;
  for (const CachedDocument& document : cache->map_documents()) {
    contents.push_back(document.key.map + " " + document.key.build + " " + document.content);
  }
  EXPECT_THAT(contents, ElementsAre("town build 2 new", "village only village"));
}

TEST_F(TileCacheTest, ACellAndADocumentOfTheMapAreDifferentThings) {
  const auto cache = open();
  const CacheKey cell{"town", "build", "", "walls", 1};
  cache->store(cell, as_bytes("cell"));
  cache->store(CacheKey::areas_document("town", "build"), as_bytes("index of cells"));
  cache->store(CacheKey::map_document("town", "build"), as_bytes("map"));
  EXPECT_EQ(text_of(cache->find(cell)), "cell");
  EXPECT_EQ(text_of(cache->find(CacheKey::areas_document("town", "build"))), "index of cells");
  EXPECT_EQ(text_of(cache->find(CacheKey::map_document("town", "build"))), "map");
}

TEST_F(TileCacheTest, ADamagedDocumentIsNotListed) {
  open()->store(CacheKey::segment_document("town", "new", "s1"), as_bytes("good"));
  change_database("UPDATE entries SET content = x'626164'");
  EXPECT_THAT(open()->segment_documents(), IsEmpty());
}

// Limits the size of this process's files, as on a full disk, until the end of the scope.
class FullDisk {
 public:
  explicit FullDisk(rlim_t file_bytes) {
    before_action_ = ::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = file_bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, before_action_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*before_action_)(int) = nullptr;
};

TEST_F(TileCacheTest, AFullDiskIsCountedAndWhatWasStoredStays) {
  const auto cache = open();
  cache->store(numbered_key(0), numbered_content(0));
  {
    const FullDisk full(100000);
    for (std::uint32_t number = 1; number < 20; ++number) {
      cache->store(numbered_key(number), numbered_content(number));
    }
    EXPECT_GT(cache->counters().failures, 0U);
    EXPECT_EQ(cache->find(numbered_key(0)), numbered_content(0));
  }
  cache->store(numbered_key(30), numbered_content(30));  // there is space again
  EXPECT_EQ(cache->find(numbered_key(30)), numbered_content(30));
  EXPECT_EQ(cache->counters().damaged_files, 0U);
}

TEST_F(TileCacheTest, ADiskThatIsFullFromTheStartIsCountedUntilThereIsRoom) {
  std::unique_ptr<TileCache> cache;
  {
    const FullDisk full(100);
    cache = open();
    cache->store(numbered_key(0), numbered_content(0));
    EXPECT_GT(cache->counters().failures, 0U);
    EXPECT_EQ(cache->find(numbered_key(0)), std::nullopt);
  }
  cache->store(numbered_key(0), numbered_content(0));
  EXPECT_EQ(cache->find(numbered_key(0)), numbered_content(0));
}

TEST_F(TileCacheTest, AFolderThatIsAFileIsRefused) {
  std::ofstream(folder_ / "occupied") << "x";
  const auto cache = TileCache::open({folder_ / "occupied", kPlenty, [] { return 0; }});
  ASSERT_FALSE(cache.ok());
  EXPECT_EQ(cache.error().code, ErrorCode::io);
  EXPECT_THAT(cache.error().line(), ::testing::HasSubstr("occupied"));
}

}  // namespace
}  // namespace milepost::testing
