// Ids that are used in URLs and file names.
#pragma once

#include <algorithm>
#include <string_view>

namespace milepost {

// 1 to 64 of [A-Za-z0-9._-], not starting with a dot: segment ids and layer names.
inline bool is_segment_id(std::string_view id) {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  };
  return !id.empty() && id.size() <= 64 && id.front() != '.' && std::ranges::all_of(id, allowed);
}

inline bool is_layer_name(std::string_view name) { return is_segment_id(name); }

}  // namespace milepost
