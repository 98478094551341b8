#include "server/message/byte_range.h"

#include <algorithm>
#include <charconv>

#include "server/message/letters.h"

namespace milepost::server {
namespace {

constexpr std::string_view kUnit = "bytes=";

// None for anything else than one or more digits. Too large a number is the largest.
std::optional<std::uint64_t> number_in(std::string_view digits) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || end != digits.data() + digits.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return UINT64_MAX;
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

// The last `wanted` bytes.
RangeRequest suffix(std::uint64_t wanted, std::uint64_t size) {
  const std::uint64_t bytes = std::min(wanted, size);
  if (bytes == 0) return {RangeRequest::Kind::beyond};
  return {RangeRequest::Kind::part, {size - bytes, bytes}};
}

}  // namespace

RangeRequest parse_range(std::string_view field, std::uint64_t size) {
  if (!equals_lower(field.substr(0, kUnit.size()), kUnit)) return {};
  const std::string_view range = field.substr(kUnit.size());
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return {};
  const auto last = number_in(range.substr(dash + 1));
  if (dash == 0) return last ? suffix(*last, size) : RangeRequest{};
  const auto first = number_in(range.substr(0, dash));
  if (!first || (!last && dash + 1 != range.size()) || (last && *last < *first)) return {};
  if (*first >= size) return {RangeRequest::Kind::beyond};
  const std::uint64_t end = last ? std::min(*last, size - 1) + 1 : size;
  return {RangeRequest::Kind::part, {*first, end - *first}};
}

bool allows_part(std::string_view if_range, std::string_view tag) {
  return if_range.empty() || if_range == tag;
}

}  // namespace milepost::server
