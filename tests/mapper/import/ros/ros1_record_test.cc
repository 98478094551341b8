#include "mapper/import/ros/ros1_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace milepost::ros {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;

std::string with_length(const std::string& text) {
  std::string length;
  for (std::size_t i = 0; i < 4; ++i) length += static_cast<char>(text.size() >> 8 * i & 0xff);
  return length + text;
}

const std::string kRecord = with_length(with_length("op=\x07") + with_length("topic=/a=b") +
                                        with_length("conn=\x01\x02\x00\x00"s)) +
                            with_length("data");

std::string refusal_of(const std::string& bytes) {
  MemoryBytes source(as_bytes(bytes));
  const auto record = ros1_record_at(source, 0);
  return record ? "accepted" : record.error().line();
}

TEST(Ros1Record, HasFieldsAndData) {
  const std::string bytes = "xyz" + kRecord + "more";
  MemoryBytes source(as_bytes(bytes));
  const auto record = ros1_record_at(source, 3);
  ASSERT_TRUE(record.ok()) << record.error().line();
  EXPECT_EQ(record->op, Ros1Op::connection);
  EXPECT_EQ(record->header.text("topic"), "/a=b");
  EXPECT_FALSE(record->header.text("type"));
  EXPECT_EQ(*record->header.number("conn"), 0x0201U);
  EXPECT_THAT(record->header.number("count").error().line(), HasSubstr("without 'count'"));
  EXPECT_EQ(bytes.substr(record->data_at, record->data_bytes), "data");
  EXPECT_EQ(record->end(), bytes.size() - 4);
}

TEST(Ros1Record, IsRefusedWhereverItIsCut) {
  ASSERT_EQ(refusal_of(kRecord), "accepted");
  for (std::size_t size = 0; size < kRecord.size(); ++size)
    EXPECT_THAT(refusal_of(kRecord.substr(0, size)), HasSubstr("is truncated")) << size;
  MemoryBytes source(as_bytes(kRecord));
  EXPECT_FALSE(ros1_record_at(source, ~std::uint64_t{0}).ok());
}

TEST(Ros1Record, BelievesNoLength) {
  EXPECT_THAT(refusal_of("\xff\xff\xff\xff"s + kRecord), HasSubstr("damaged"));
  EXPECT_THAT(refusal_of(with_length("\xff\xff\xff\xff" + with_length("op=\x07")) + kRecord),
              HasSubstr("has a damaged record"));
  EXPECT_THAT(refusal_of(with_length("\x01") + kRecord), HasSubstr("has a damaged record"));
  EXPECT_THAT(refusal_of(with_length(with_length("op")) + kRecord),
              HasSubstr("has a damaged record"));
  EXPECT_THAT(refusal_of(with_length(with_length("conn=1")) + with_length("")),
              HasSubstr("has a record without 'op'"));
}

}  // namespace
}  // namespace milepost::ros
