// Tiles whose content follows from their number, so that any process can check them.
#pragma once

#include <string>

#include "client/cache/tile_cache.h"

namespace milepost::testing {

inline CacheKey numbered_key(std::uint32_t number) {
  return {"town", "build", "s1", "tracklets", number};
}

inline Bytes numbered_content(std::uint32_t number) {
  const std::string text = std::to_string(number) + ",";
  Bytes content;
  while (content.size() < 20000) content.insert(content.end(), text.begin(), text.end());
  return content;
}

}  // namespace milepost::testing
