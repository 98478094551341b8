// Serialises messages for tests.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "mapper/import/ros/message_reader.h"
#include "schema/base/bytes.h"

namespace milepost::ros::testing {

class MessageWriter {
 public:
  explicit MessageWriter(Serialization serialization, bool is_big_endian = false)
      : is_cdr_(serialization == Serialization::cdr), is_big_endian_(is_big_endian) {
    const std::uint8_t order = is_big_endian ? 0 : 1;
    if (is_cdr_) bytes_ = {0, order, 0, 0};
  }

  template <class Value>
  MessageWriter& number(Value value) {
    while (is_cdr_ && (bytes_.size() - 4) % sizeof(Value) != 0) bytes_.push_back(0);
    auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(Value)>>(value);
    if (is_big_endian_) std::ranges::reverse(bytes);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  MessageWriter& doubles(std::initializer_list<double> values) {
    for (const double value : values) number(value);
    return *this;
  }
  MessageWriter& doubles(std::size_t count, double value) {
    for (std::size_t i = 0; i < count; ++i) number(value);
    return *this;
  }
  MessageWriter& text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size() + (is_cdr_ ? 1 : 0)));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    if (is_cdr_) bytes_.push_back(0);
    return *this;
  }
  MessageWriter& bytes(const Bytes& bytes) {
    number(static_cast<std::uint32_t>(bytes.size()));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  // At 12.5 s.
  MessageWriter& header() {
    if (!is_cdr_) number(std::uint32_t{7});
    return number(std::uint32_t{12}).number(std::uint32_t{500'000'000}).text("map");
  }

  const Bytes& message() const { return bytes_; }

 private:
  bool is_cdr_;
  bool is_big_endian_;
  Bytes bytes_;
};

}  // namespace milepost::ros::testing
