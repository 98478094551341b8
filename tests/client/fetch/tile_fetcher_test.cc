#include "client/fetch/tile_fetcher.h"

#include <gtest/gtest.h>

#include "schema/base/digest.h"
#include "tests/support/scripted_server.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {
namespace {

constexpr std::size_t kTileBytes = 100;

Bytes tile_of(std::uint32_t number) { return Bytes(kTileBytes, static_cast<std::uint8_t>(number)); }

ExpectedTile expected(std::uint32_t number) {
  return {number, kTileBytes, digest_of(tile_of(number))};
}

// Tiles 1, 2 and 3 come in one response, whichever is requested, and it is interrupted.
class FetchingTiles : public ::testing::Test {
 protected:
  Result<std::map<std::uint32_t, Bytes>> fetch(const std::vector<ExpectedTile>& wanted) {
    return fetcher_.fetch(
        {"map", "build", "s", "layer", 0}, wanted,
        [this](const std::set<std::uint32_t>&) {
          return CheckedRequest{server_.url() + "/tiles", {expected(1), expected(2), expected(3)}};
        },
        {});
  }

  std::size_t break_off_after_ = 0;
  ScriptedServer server_{[this](const std::string&) {
    std::string body;
    for (const std::uint32_t number : {1U, 2U, 3U}) body += as_text(tile_of(number));
    return ScriptedAnswer{.body = body, .break_off_after = break_off_after_};
  }};
  TempFolder folder_;
  std::unique_ptr<TileCache> cache_ = TileCache::open({folder_.path()}).value();
  ServerRequests requests_{make_curl_transport({5, 10}),
                           {.attempts = 3, .sleep = [](double, const Stopped&) {}}};
  TileFetcher fetcher_{requests_, *cache_};
};

// Tile 1 is not requested: a response interrupted after it brought nothing that was missing,
// however often it is repeated.
TEST_F(FetchingTiles, WhatOnlyComesAlongIsNoProgress) {
  break_off_after_ = kTileBytes + 10;
  const auto tiles = fetch({expected(2), expected(3)});
  ASSERT_FALSE(tiles.ok());
  EXPECT_EQ(tiles.error().code, ErrorCode::unavailable);
  EXPECT_EQ(requests_.made(), 3U);
}

TEST_F(FetchingTiles, WhatWasMissingIsKeptAndTheRestAskedForAgain) {
  break_off_after_ = 2 * kTileBytes + 10;
  const auto tiles = fetch({expected(2), expected(3)});
  ASSERT_FALSE(tiles.ok());
  EXPECT_EQ(requests_.made(), 1U + 3U);  // tile 2 in the first
  EXPECT_TRUE(fetcher_.find({"map", "build", "s", "layer", 0}, expected(2)));
}

}  // namespace
}  // namespace milepost::testing
