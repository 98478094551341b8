#include "client/fetch/tile_cutter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/client/fetch/fake_map.h"

namespace milepost::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class TileCutterTest : public ::testing::Test {
 protected:
  TileCutter cutter() {
    return {"http://here/",
            {expected_tile(map_.index[2]), expected_tile(map_.index[3])},
            [this](std::uint32_t index, const Bytes& f) {
              EXPECT_EQ(f, map_.encoded_tile(index));
              received_.push_back(index);
            }};
  }

  FakeMap map_;
  std::string body_ = map_.range_body({50, 62});  // tiles 2 and 3
  std::vector<std::uint32_t> received_;
};

TEST_F(TileCutterTest, CutsWhereverThePiecesEnd) {
  for (std::size_t piece = 1; piece <= body_.size(); piece += 37) {
    received_.clear();
    TileCutter cut = cutter();
    for (std::size_t at = 0; at < body_.size(); at += piece) {
      ASSERT_TRUE(cut.take(as_bytes(std::string_view(body_).substr(at, piece))).ok());
    }
    EXPECT_TRUE(cut.finish().ok());
    EXPECT_THAT(received_, ::testing::ElementsAre(2, 3));
  }
}

TEST_F(TileCutterTest, ATileIsReceivedAsSoonAsItIsWhole) {
  TileCutter cut = cutter();
  ASSERT_TRUE(cut.take(as_bytes(body_.substr(0, 1020))).ok());
  EXPECT_EQ(cut.received(), 1U);
  const Status finished = cut.finish();
  ASSERT_FALSE(finished.ok());
  EXPECT_EQ(finished.error().code, ErrorCode::corrupt);
  EXPECT_THAT(finished.error().line(), HasSubstr("tile 3"));
}

TEST_F(TileCutterTest, AnyWrongByteIsFound) {
  for (std::size_t at = 0; at < body_.size(); at += 101) {
    std::string spoiled = body_;
    spoiled[at] ^= 4;
    TileCutter cut = cutter();
    const Status taken = cut.take(as_bytes(spoiled));
    ASSERT_FALSE(taken.ok()) << at;
    EXPECT_EQ(taken.error().code, ErrorCode::corrupt);
    EXPECT_THAT(taken.error().line(), StartsWith("http://here/: "));
    EXPECT_EQ(cut.received(), at < 1020 ? 0U : 1U);
  }
}

TEST_F(TileCutterTest, NothingMayFollow) {
  TileCutter cut = cutter();
  EXPECT_FALSE(cut.take(as_bytes(body_ + "x")).ok());
}

}  // namespace
}  // namespace milepost::testing
