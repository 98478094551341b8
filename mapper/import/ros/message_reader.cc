#include "mapper/import/ros/message_reader.h"

#include <string>

namespace milepost::ros {
namespace {

constexpr std::size_t kCdrHeaderBytes = 4;
constexpr std::size_t kMaxCdrPadding = 3;  // after the last field

}  // namespace

MessageReader::MessageReader(ByteView message, Serialization serialization)
    : serialization_(serialization), body_(message) {
  constexpr bool kIsBigEndian = std::endian::native == std::endian::big;
  is_swapped_ = kIsBigEndian;
  if (serialization == Serialization::ros1) return;
  is_known_ = message.size() >= kCdrHeaderBytes && message[0] == 0 && message[1] <= 1;
  if (!is_known_) return;
  is_swapped_ = (message[1] == 0) != kIsBigEndian;
  body_ = message.subspan(kCdrHeaderBytes);
}

ByteView MessageReader::take(std::size_t count, std::size_t number_size) {
  const std::size_t beyond = serialization_ == Serialization::cdr ? at_ % number_size : 0;
  const std::size_t gap = beyond == 0 ? 0 : number_size - beyond;
  is_cut_ = is_cut_ || left() < gap || left() - gap < count;
  if (is_cut_) return {};
  const ByteView bytes = body_.subspan(at_ + gap, count);
  at_ += gap + count;
  return bytes;
}

std::string_view MessageReader::text() {
  std::string_view text = as_text(bytes());
  if (serialization_ == Serialization::cdr && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

ByteView MessageReader::bytes() { return take(number<std::uint32_t>(), 1); }

std::vector<double> MessageReader::doubles() {
  const auto count = number<std::uint32_t>();
  is_cut_ = is_cut_ || left() / sizeof(double) < count;
  if (is_cut_) return {};
  std::vector<double> values(count);
  for (double& value : values) value = number<double>();
  return values;
}

Status MessageReader::finish() const {
  if (!is_known_) {
    return Error{ErrorCode::corrupt, "", "is not serialised as CDR",
                 "record the topic with the usual serialisation"};
  }
  if (is_cut_) {
    return Error{ErrorCode::corrupt, "", "is cut short, or is no such message",
                 "copy the bag again"};
  }
  const std::size_t padding = serialization_ == Serialization::cdr ? kMaxCdrPadding : 0;
  if (left() <= padding) return ok_status();
  return Error{ErrorCode::corrupt, "",
               "has " + std::to_string(left()) + " bytes too many, or is no such message",
               "copy the bag again"};
}

}  // namespace milepost::ros
