// A cache in a temporary folder, and helpers to damage it.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cache/tile_cache.h"
#include "tests/client/cache/numbered_tile.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {

inline constexpr std::uint64_t kPlenty = 1ULL << 30U;

inline Bytes bytes_of_size(std::size_t size, std::uint8_t value) { return Bytes(size, value); }

inline std::string text_of(const std::optional<Bytes>& content) {
  return content.has_value() ? std::string(as_text(*content)) : "(absent)";
}

class CacheTest : public ::testing::Test {
 protected:
  std::unique_ptr<TileCache> open(std::uint64_t limit_bytes = kPlenty) {
    auto cache = TileCache::open({folder_.path(), limit_bytes, [this] { return now_s_; }});
    EXPECT_TRUE(cache.ok()) << cache.error().line();
    return std::move(cache).value();
  }

  // Runs SQL in the cache's file as another program would.
  void change_database(const std::string& sql, const std::string& name = "tiles-1.sqlite") const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / name).c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }

  // Tiles of 100 bytes.
  static void store_tiles(TileCache& cache, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t number = from; number < to; ++number) {
      cache.store(numbered_key(number), bytes_of_size(100, 1));
    }
  }

  // Finds the tiles 0 to `count` in this order, which marks each as used.
  static std::vector<std::uint32_t> present(TileCache& cache, std::uint32_t count) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t number = 0; number < count; ++number) {
      if (cache.find(numbered_key(number)).has_value()) numbers.push_back(number);
    }
    return numbers;
  }

  TempFolder folder_;
  std::int64_t now_s_ = 1000;
};

}  // namespace milepost::testing
