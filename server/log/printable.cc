#include "server/log/printable.h"

namespace milepost::server {

std::string printable(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string shown;
  shown.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7f) {
      shown.append("\\x").append({kDigits[byte / 16], kDigits[byte % 16]});
    } else {
      if (c == '\\' || c == '"') shown += '\\';
      shown += c;
    }
  }
  return shown;
}

}  // namespace milepost::server
