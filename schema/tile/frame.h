// The zstd frame around a tile's content (FORMAT.md 3.2).
#pragma once

#include <cstddef>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost {

inline constexpr std::size_t kMaxTileContentBytes = std::size_t{16} << 20U;

// One frame with content size and checksum. The same content gives the same bytes.
// REQUIRES: content.size() <= kMaxTileContentBytes.
Bytes compress_frame(ByteView content);

// The content of exactly one frame. Allocates no more than kMaxTileContentBytes.
// Errors: corrupt, naming the paragraph broken.
Result<Bytes> expand_frame(ByteView frame);

// The length of the frame at the start of `stream`; 0 if the stream ends inside the frame.
// Errors: corrupt (no frame, or none that can be a tile's).
Result<std::size_t> frame_length(ByteView stream);

}  // namespace milepost
