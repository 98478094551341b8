// The stored frames that are the body of a response: its tiles or cells.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "schema/base/result.h"
#include "server/hot/hot_frames.h"
#include "server/message/response.h"

namespace milepost::server {

// Bytes that are read ahead of a client: memory for a connection whose client is slow.
inline constexpr std::size_t kReadAheadBytes = 131'072;

// 0 if the body is a text.
std::size_t frame_count(const Response& response);

// REQUIRES: `index` < frame_count, here and below.
std::string_view frame_digest(const Response& response, std::size_t index);

// Frames of a response's map from `first` on: as many as make up kReadAheadBytes, and at least one;
// those not in memory are read from the disk, which may take long, and enter it. Fewer before a
// frame that cannot be read. Errors, if that is the first one: those of ServedMap::tile and cell.
Result<std::vector<Frame>> read_frames(const Response& response, const ServedMap& map,
                                       std::size_t first, HotFrames& memory);

}  // namespace milepost::server
