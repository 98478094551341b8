// What stored tiles hold, as documents for the viewer: a browser decodes neither zstd frames nor
// FlatBuffers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost::server {

// A document has at most this many items, spread evenly over those of the tile.
inline constexpr std::size_t kMaxShownItems = 4096;

// The landmarks of an encoded tile (PROTOCOL.md). `segment_document` is that of the tile's segment.
// Errors: corrupt.
Result<std::string> landmarks_document(ByteView frame, std::string_view segment_document);
// The walls of an encoded cell. Errors: corrupt.
Result<std::string> walls_document(ByteView frame);

}  // namespace milepost::server
