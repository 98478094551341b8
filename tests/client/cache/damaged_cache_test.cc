// Wrong clocks, invalid numbers in the file, and foreign files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/client/cache/cache_test.h"

namespace milepost::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

using DamagedCacheTest = CacheTest;

const std::string kMost = std::to_string(std::numeric_limits<std::int64_t>::max());

std::vector<std::uint32_t> from_to(std::uint32_t from, std::uint32_t to) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t number = from; number < to; ++number) numbers.push_back(number);
  return numbers;
}

TEST_F(DamagedCacheTest, NoClockDecidesWhatWasUsedLast) {
  const std::int64_t in_2036_s = 2085978496;
  for (const std::int64_t wrong_s : {std::int64_t{0}, in_2036_s}) {
    SCOPED_TRACE(wrong_s);
    const auto cache = open(300);
    now_s_ = wrong_s;
    store_tiles(*cache, 0, 3);
    now_s_ = 1790000000;
    store_tiles(*cache, 3, 5);
    now_s_ = 0;
    store_tiles(*cache, 5, 7);
    EXPECT_EQ(present(*cache, 7), from_to(4, 7));
    for (std::uint32_t number = 0; number < 7; ++number) cache->remove(numbered_key(number));
  }
}

TEST_F(DamagedCacheTest, TheOrderOfUsesIsKeptInTheFile) {
  store_tiles(*open(300), 0, 3);
  EXPECT_TRUE(open(300)->find(numbered_key(0)).has_value());
  store_tiles(*open(300), 3, 4);
  EXPECT_THAT(present(*open(300), 4), ElementsAre(0, 2, 3));
}

TEST_F(DamagedCacheTest, UsesThroughSeveralConnectionsAreOneOrder) {
  const auto first = open(300);
  const auto second = open(300);
  first->store(numbered_key(0), bytes_of_size(100, 1));
  second->store(numbered_key(1), bytes_of_size(100, 1));
  first->store(numbered_key(2), bytes_of_size(100, 1));
  second->touch(numbered_key(0));
  first->touch(numbered_key(1));
  second->store(numbered_key(3), bytes_of_size(100, 1));
  EXPECT_THAT(present(*first, 4), ElementsAre(0, 1, 3));
}

TEST_F(DamagedCacheTest, AnAbsurdUseIsSoonForgotten) {
  for (const std::string absurd : {kMost.c_str(), "4611686018427387903", "-", "0"}) {
    const std::string number = absurd == "-" ? "-" + kMost : absurd;
    for (const bool while_open : {false, true}) {
      SCOPED_TRACE(number + (while_open ? ", while open" : ""));
      auto cache = open(300);
      store_tiles(*cache, 0, 3);
      if (!while_open) cache.reset();
      change_database("UPDATE entries SET last_use = " + number + " WHERE number = 1");
      if (!while_open) cache = open(300);
      store_tiles(*cache, 3, 5);
      cache->touch(numbered_key(3));
      store_tiles(*cache, 5, 7);
      EXPECT_THAT(present(*cache, 7), ElementsAre(3, 5, 6));
      EXPECT_EQ(cache->counters().failures, 0U);
      EXPECT_EQ(cache->bytes(), 300U);
    }
  }
}

TEST_F(DamagedCacheTest, UsesThatAreAllAbsurdAreSoonForgotten) {
  const auto cache = open(300);
  store_tiles(*cache, 0, 3);
  change_database("UPDATE entries SET last_use = " + kMost);
  store_tiles(*cache, 3, 6);
  EXPECT_EQ(present(*cache, 6), from_to(3, 6));
  EXPECT_EQ(cache->counters().failures, 0U);
}

// SQL that makes the stored total differ from the sum over the entries.
const std::vector<std::string> kWrongTotals = {
    "UPDATE total SET bytes = 1000000000000000",
    "UPDATE total SET bytes = 1100",
    "UPDATE total SET bytes = -1000000000000000",
    "UPDATE total SET bytes = " + kMost,
    "UPDATE total SET bytes = -" + kMost,
    "DELETE FROM total",
    "INSERT INTO total VALUES (1000000000)",
    "DROP TABLE total; CREATE TABLE total (bytes INTEGER); INSERT INTO total VALUES (NULL)",
    "DROP TABLE total; CREATE TABLE total (bytes TEXT); INSERT INTO total VALUES ('much')",
};

TEST_F(DamagedCacheTest, AWrongTotalIsRecomputedAtTheStart) {
  for (const std::string& damage : kWrongTotals) {
    SCOPED_TRACE(damage);
    store_tiles(*open(1000), 0, 10);
    change_database(damage);
    const auto cache = open(1000);
    EXPECT_EQ(cache->bytes(), 1000U);
    EXPECT_EQ(present(*cache, 10), from_to(0, 10));
    store_tiles(*cache, 10, 12);
    EXPECT_EQ(present(*cache, 12), from_to(2, 12));
    EXPECT_EQ(cache->counters().failures, 0U);
  }
}

TEST_F(DamagedCacheTest, AWrongTotalIsRecomputedDuringUse) {
  for (const std::string& damage : kWrongTotals) {
    SCOPED_TRACE(damage);
    const auto cache = open(1000);
    store_tiles(*cache, 0, 10);
    change_database(damage);
    store_tiles(*cache, 10, 12);
    EXPECT_EQ(present(*cache, 12), from_to(2, 12));
    EXPECT_EQ(cache->bytes(), 1000U);
    EXPECT_EQ(cache->counters().failures, 0U);
  }
}

TEST_F(DamagedCacheTest, ATotalThatIsWrongButPossibleDoesNotKeepTheCacheEmpty) {
  const auto cache = open(1000);
  store_tiles(*cache, 0, 2);
  change_database("UPDATE total SET bytes = 1000");
  store_tiles(*cache, 2, 200);
  EXPECT_EQ(present(*cache, 200), from_to(190, 200));
  EXPECT_EQ(cache->bytes(), 1000U);
}

TEST_F(DamagedCacheTest, AnAbsurdSizeCostsItsOwnEntryOnly) {
  for (const std::string size : {kMost.c_str(), "1000000000000000", "-5000"}) {
    SCOPED_TRACE(size);
    store_tiles(*open(1000), 0, 10);
    change_database("UPDATE entries SET bytes = " + size + " WHERE number IN (3, 9)");
    const auto cache = open(1000);
    EXPECT_THAT(present(*cache, 10), ElementsAre(0, 1, 2, 4, 5, 6, 7, 8));
    EXPECT_EQ(cache->bytes(), 800U);
    EXPECT_EQ(cache->counters().failures, 0U);
  }
}

TEST_F(DamagedCacheTest, ASizeThatIsNotTheContentsIsFoundAndTheEntryDropped) {
  const auto cache = open(1000);
  store_tiles(*cache, 0, 5);
  change_database("UPDATE entries SET bytes = 700 WHERE number = 3");
  EXPECT_THAT(present(*cache, 5), ElementsAre(0, 1, 2, 4));
  EXPECT_EQ(cache->counters().damaged_entries, 1U);
  store_tiles(*cache, 5, 20);
  EXPECT_EQ(present(*cache, 20), from_to(10, 20));
}

// A file that violates its constraints cannot be distinguished from one with changed bytes.
TEST_F(DamagedCacheTest, AnEntryThatCannotBeRemovedCostsTheFile) {
  const auto cache = open(300);
  store_tiles(*cache, 0, 3);
  change_database(
      "CREATE TRIGGER stubborn BEFORE DELETE ON entries"
      " BEGIN SELECT raise(ABORT, 'stays'); END");
  store_tiles(*cache, 3, 5);
  EXPECT_THAT(present(*cache, 5), ElementsAre(4));
  EXPECT_EQ(cache->counters().damaged_files, 1U);
}

class ForeignFilesTest : public CacheTest {
 protected:
  void write_garbage(const std::string& name) const {
    std::ofstream(folder_ / name) << std::string(10000, 'x');
  }

  // Whether an entry stored in one run is found in the next.
  void expect_remembers(std::uint32_t number) {
    open()->store(numbered_key(number), numbered_content(number));
    const auto cache = open();
    EXPECT_EQ(cache->find(numbered_key(number)), numbered_content(number));
    EXPECT_EQ(cache->counters().failures, 0U);
  }
};

TEST_F(ForeignFilesTest, NamesWithOtherNumbersAreNotTheCaches) {
  expect_remembers(1);
  const std::vector<std::string> names = {
      "tiles-2147483647.sqlite", "tiles-2147483648.sqlite", "tiles-99999999999999.sqlite",
      "tiles-1000000.sqlite",    "tiles-0.sqlite",          "tiles--7.sqlite",
      "tiles-.sqlite",           "tiles-1x.sqlite",         "tiles-18446744073709551617.sqlite",
  };
  for (const std::string& name : names) write_garbage(name);
  EXPECT_EQ(open()->find(numbered_key(1)), numbered_content(1));
  expect_remembers(2);
  for (const std::string& name : names) EXPECT_TRUE(fs::exists(folder_ / name)) << name;
}

TEST_F(ForeignFilesTest, AfterTheLastGenerationComesTheFirst) {
  write_garbage("tiles-999999.sqlite");
  expect_remembers(1);
  EXPECT_TRUE(fs::exists(folder_ / "tiles-1.sqlite"));
  EXPECT_TRUE(fs::exists(folder_ / "tiles-999999.sqlite.damaged"));
}

TEST_F(ForeignFilesTest, AfterTheLastGenerationComesOneThatIsFree) {
  write_garbage("tiles-1.sqlite");
  write_garbage("tiles-999999.sqlite");
  expect_remembers(1);
  expect_remembers(2);
}

TEST_F(ForeignFilesTest, AllWhoShareTheLastGenerationMoveOnToTheSameNewOne) {
  store_tiles(*open(), 0, 1);
  fs::rename(folder_ / "tiles-1.sqlite", folder_ / "tiles-999999.sqlite");
  const auto first = open();
  const auto second = open();
  change_database("DROP TABLE total", "tiles-999999.sqlite");
  store_tiles(*first, 2, 3);   // detects the damage, replaces the file
  store_tiles(*second, 2, 3);  // detects the damage, finds the new file
  store_tiles(*first, 3, 4);
  store_tiles(*second, 4, 5);
  EXPECT_THAT(present(*first, 5), ElementsAre(3, 4));
  EXPECT_THAT(present(*second, 5), ElementsAre(3, 4));
  EXPECT_FALSE(fs::exists(folder_ / "tiles-2.sqlite"));
}

TEST_F(ForeignFilesTest, AFolderOrAFifoUnderTheFilesNameIsPassedOver) {
  fs::create_directory(folder_ / "tiles-1.sqlite");
  expect_remembers(1);
  ASSERT_EQ(::mkfifo((folder_ / "tiles-7.sqlite").c_str(), 0600), 0);
  EXPECT_EQ(open()->find(numbered_key(1)), numbered_content(1));
  expect_remembers(2);
}

}  // namespace
}  // namespace milepost::testing
