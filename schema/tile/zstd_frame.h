// The zstd frame around a tile's content (FORMAT.md 3.2).
#pragma once

#include <cstddef>
#include <span>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost {

inline constexpr std::size_t kMaxTileContentBytes = std::size_t{16} << 20U;

// One frame with content size and checksum. Deterministic. A block ends at each of `cuts`, which
// costs about 50 bytes and pays where the distribution of values changes, since zstd has one
// entropy table per block.
// REQUIRES: content.size() <= kMaxTileContentBytes; cuts ascend and are within the content.
Bytes compress_frame(ByteView content, std::span<const std::size_t> cuts = {});

// The content of exactly one frame. Allocates no more than kMaxTileContentBytes.
// Errors: corrupt, naming the violated paragraph.
Result<Bytes> expand_frame(ByteView frame);

// The length of the frame at the start of `stream`; 0 if the stream ends inside the frame.
// Errors: corrupt (not a frame, or one that cannot be a tile's).
Result<std::size_t> frame_length(ByteView stream);

}  // namespace milepost
