// The fields of a serialised ROS message, one after the other.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost::ros {

// How the fields lie. Numbers are IEEE 754 or two's complement; text and sequences begin with their
// length as 32 bits.
enum class Serialization {
  ros1,  // without gaps, little endian
  cdr    // ROS 2: the second byte tells the byte order; from the fifth on each number lies at a
         // multiple of its size, and text ends with a zero (OMG's CDR, first version)
};

template <class Value>
concept Number = std::integral<Value> || std::floating_point<Value>;

// A field that the message is too short for reads as 0 or as empty, and finish() tells. No length
// in the message is believed beyond the message's own.
class MessageReader {
 public:
  // REQUIRES: `message` outlives the reader and the views that it returns.
  MessageReader(ByteView message, Serialization serialization);

  Serialization serialization() const { return serialization_; }

  template <Number Value>
  Value number() {
    std::array<std::uint8_t, sizeof(Value)> native{};
    const ByteView bytes = take(sizeof(Value), sizeof(Value));
    std::ranges::copy(bytes, native.begin());
    if (is_swapped_) std::ranges::reverse(native);
    return std::bit_cast<Value>(native);
  }

  template <Number Value, std::size_t count>
  std::array<Value, count> numbers() {
    std::array<Value, count> values{};
    for (Value& value : values) value = number<Value>();
    return values;
  }

  std::string_view text();
  ByteView bytes();               // a sequence of them
  std::vector<double> doubles();  // a sequence of them

  // Errors: corrupt (no CDR, the message ended before its fields, or goes on after them); `where`
  // is left to the caller.
  Status finish() const;

 private:
  // The next `count` bytes, of numbers of this size. Nothing if they are not all there.
  ByteView take(std::size_t count, std::size_t number_size);
  std::size_t left() const { return body_.size() - at_; }

  Serialization serialization_;
  ByteView body_;
  std::size_t at_ = 0;
  bool is_swapped_ = false;
  bool is_known_ = true;
  bool is_cut_ = false;
};

}  // namespace milepost::ros
