// Tables of a broken or hostile writer, with which every kind of tile is tested.
#pragma once

#include <flatbuffers/flatbuffers.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/tile/zstd_frame.h"

namespace milepost::testing {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A change that makes a valid table violate one paragraph of FORMAT.md, and the expected message.
template <class Table>
struct Violation {
  const char* name;
  std::function<void(Table&)> make;
  const char* message;

  friend void PrintTo(const Violation& violation, std::ostream* out) { *out << violation.name; }
};

template <class Table>
std::string name_of(const ::testing::TestParamInfo<Violation<Table>>& test) {
  return test.param.name;
}

// A table of that kind of tile as the content of its zstd frame.
template <class Root>
Bytes content_of(flatbuffers::FlatBufferBuilder& builder, const Root& root,
                 const char* identifier) {
  builder.FinishSizePrefixed(root, identifier);
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

// The error message of the decoder of a kind of tile for such a content.
template <class Tile>
std::string message_of(const Bytes& content, Result<Tile> (*decode)(ByteView encoded)) {
  const Result<Tile> tile = decode(compress_frame(content));
  return tile ? "no error" : tile.error().line();
}

// Violations of the head of tiles along a segment, followed by those of the kind.
template <class Table>
std::vector<Violation<Table>> with_broken_heads(std::vector<Violation<Table>> violations) {
  const char* const kSegment = "the segment id is invalid (FORMAT.md 3.4)";
  const char* const kOrigin = "origin_m is out of range (FORMAT.md 3.4)";
  violations.insert(violations.begin(),
                    {{"EmptySegment", [](Table& t) { t.segment = ""; }, kSegment},
                     {"SegmentWithSlash", [](Table& t) { t.segment = "a/b"; }, kSegment},
                     {"NanOrigin", [](Table& t) { t.origin_m = kNan; }, kOrigin},
                     {"FarOrigin", [](Table& t) { t.origin_m = 1.1e8; }, kOrigin},
                     {"FarOriginBehind", [](Table& t) { t.origin_m = -1.1e8; }, kOrigin}});
  return violations;
}

template <class FromTable>
void expect_truncations_refused(const Bytes& content, const FromTable& from_table) {
  for (std::size_t length = 0; length < content.size(); ++length) {
    EXPECT_FALSE(from_table(ByteView(content).first(length)).ok()) << length;
  }
}

// Damage with a valid checksum, as a hostile server would send it: rejected or harmless, and what
// is accepted satisfies FORMAT.md.
template <class FromTable, class ToTable>
void expect_damage_harmless(const Bytes& good, const FromTable& from_table,
                            const ToTable& to_table) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20000; ++trial) {
    Bytes content = good;
    for (int i = 0; i < 1 + trial % 4; ++i) {
      content[random() % content.size()] = static_cast<std::uint8_t>(random());
    }
    const auto tile = from_table(content);
    if (!tile.ok()) {
      EXPECT_THAT(tile.error().line(), ::testing::HasSubstr("FORMAT.md "));
    } else {
      EXPECT_TRUE(from_table(to_table(*tile)).ok()) << "trial " << trial;
    }
  }
}

}  // namespace milepost::testing
