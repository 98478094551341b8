// milepost_cache_writer FOLDER: stores tiles of the map "town" until it is killed, and writes a
// line for each. The content of tile N is N as text, many times over.
#include <cstdio>
#include <string>

#include "client/cache/tile_cache.h"
#include "tests/client/cache/numbered_tile.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  auto cache = milepost::TileCache::open({argv[1], 1ULL << 30U, [] { return std::int64_t{1}; }});
  if (!cache.ok()) return 1;
  for (std::uint32_t number = 0;; ++number) {
    (*cache)->store(milepost::testing::numbered_key(number),
                    milepost::testing::numbered_content(number));
    std::printf("%u\n", number);
    std::fflush(stdout);
  }
}
