// Comparison without regard to the case of ASCII letters, as most names in HTTP are compared.
#pragma once

#include <algorithm>
#include <string_view>

namespace milepost::server {

// REQUIRES: `lower` is in lower case.
inline bool equals_lower(std::string_view text, std::string_view lower) {
  return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                    [](char c, char l) { return (c >= 'A' && c <= 'Z' ? c + 32 : c) == l; });
}

}  // namespace milepost::server
