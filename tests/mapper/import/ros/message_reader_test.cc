#include "mapper/import/ros/message_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace milepost::ros {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Bytes bytes_of(std::string_view hexadecimal) {
  Bytes bytes;
  for (std::size_t i = 0; i < hexadecimal.size(); i += 2)
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(hexadecimal.substr(i, 2)), nullptr, 16)));
  return bytes;
}

// 1 of one byte, "ab", 1.5, and a sequence of 2.5: written by eProsima's Fast CDR.
const Bytes kLittle = bytes_of(
    "0001000001000000030000006162000000000000000000000000f83f01000000000000000000000000000440");
const Bytes kBig = bytes_of(
    "00000000010000000000000361620000000000003ff800000000000000000001000000004004000000000000");

std::string refusal_of(const MessageReader& reader) {
  const Status finish = reader.finish();
  return finish ? "accepted" : finish.error().line();
}

TEST(MessageReader, Ros1HasNoGaps) {
  const Bytes message = bytes_of("01020000006162000000000000f83f");
  MessageReader reader(message, Serialization::ros1);
  EXPECT_EQ(reader.number<std::uint8_t>(), 1);
  EXPECT_EQ(reader.text(), "ab");
  EXPECT_EQ(reader.number<double>(), 1.5);
  EXPECT_TRUE(reader.finish().ok());
}

TEST(MessageReader, CdrHasGapsAndTellsItsByteOrder) {
  for (const Bytes& message : {kLittle, kBig}) {
    MessageReader reader(message, Serialization::cdr);
    EXPECT_EQ(reader.number<std::uint8_t>(), 1);
    EXPECT_EQ(reader.text(), "ab");
    EXPECT_EQ(reader.number<double>(), 1.5);
    EXPECT_THAT(reader.doubles(), ElementsAre(2.5));
    EXPECT_TRUE(reader.finish().ok());
  }
}

TEST(MessageReader, TellsThatTheMessageEndsTooEarly) {
  for (std::size_t size = 4; size < kLittle.size(); ++size) {
    MessageReader reader(ByteView(kLittle).first(size), Serialization::cdr);
    reader.number<std::uint8_t>();
    reader.text();
    reader.number<double>();
    reader.doubles();
    EXPECT_THAT(refusal_of(reader), HasSubstr("is cut short")) << size;
  }
}

TEST(MessageReader, BelievesNoLengthBeyondTheMessage) {
  const Bytes message = bytes_of("ffffffff00000000");
  MessageReader text(message, Serialization::ros1);
  EXPECT_EQ(text.text(), "");
  EXPECT_THAT(refusal_of(text), HasSubstr("is cut short"));
  MessageReader doubles(message, Serialization::ros1);
  EXPECT_THAT(doubles.doubles(), IsEmpty());
  EXPECT_THAT(refusal_of(doubles), HasSubstr("is cut short"));
  EXPECT_EQ(doubles.number<std::uint32_t>(), 0U);  // nothing is read after a failure
}

TEST(MessageReader, TellsThatTheMessageGoesOn) {
  Bytes message = bytes_of("0100");
  MessageReader ros1(message, Serialization::ros1);
  ros1.number<std::uint8_t>();
  EXPECT_THAT(refusal_of(ros1), HasSubstr("has 1 bytes too many"));
  message = bytes_of("000100000100000000");
  for (const auto& [size, is_accepted] : {std::pair{8U, true}, {9U, false}}) {
    MessageReader cdr(ByteView(message).first(size), Serialization::cdr);
    cdr.number<std::uint8_t>();  // three bytes may fill it up
    EXPECT_EQ(cdr.finish().ok(), is_accepted) << size;
  }
}

TEST(MessageReader, RefusesOtherSerialisations) {
  for (const char* const message : {"", "000100", "00030000aabbccdd", "00070000aabbccdd"}) {
    const Bytes bytes = bytes_of(message);
    const MessageReader reader(bytes, Serialization::cdr);
    EXPECT_THAT(refusal_of(reader), HasSubstr("is not serialised as CDR")) << message;
  }
}

}  // namespace
}  // namespace milepost::ros
