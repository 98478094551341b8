// The zstd frame around a tile's content (FORMAT.md 3.2).
#pragma once

#include <cstddef>
#include <span>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost {

inline constexpr std::size_t kMaxTileContentBytes = std::size_t{16} << 20U;

// One frame with content size and checksum. The same content gives the same bytes. A block ends at
// each of `cuts`: worth its 50 bytes or so where the values change their distribution, for zstd has
// one table of codes a block.
// REQUIRES: content.size() <= kMaxTileContentBytes; cuts ascend and are within the content.
Bytes compress_frame(ByteView content, std::span<const std::size_t> cuts = {});

// The content of exactly one frame. Allocates no more than kMaxTileContentBytes.
// Errors: corrupt, naming the paragraph broken.
Result<Bytes> expand_frame(ByteView frame);

// The length of the frame at the start of `stream`; 0 if the stream ends inside the frame.
// Errors: corrupt (no frame, or none that can be a tile's).
Result<std::size_t> frame_length(ByteView stream);

}  // namespace milepost
