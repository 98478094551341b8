// What stored tiles hold, as documents for the viewer: a browser decodes neither zstd frames nor
// FlatBuffers.
#pragma once

#include <string>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/geo/route_line.h"

namespace milepost::server {

// A document has at most this many items, spread evenly over those of the tile.
inline constexpr std::size_t kMaxShownItems = 4096;

// The landmarks of an encoded tile of a segment with this line (PROTOCOL.md). Errors: corrupt.
Result<std::string> landmarks_document(ByteView frame, const RouteLine& line);
// The walls of an encoded cell. Errors: corrupt.
Result<std::string> walls_document(ByteView frame);

}  // namespace milepost::server
