// A tile's content: the FlatBuffers table of tile.fbs, size-prefixed (FORMAT.md 3.3 to 3.10).
#pragma once

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/tile/tracklet.h"

namespace milepost {

inline constexpr std::size_t kMaxTrackletsPerTile = 65536;
inline constexpr double kMaxAlongM = 1e8;

// The same tile gives the same bytes. REQUIRES: as encode_tile.
Bytes table_from_tile(const TrackletTile& tile);

// Never trusts a byte. REQUIRES: the bytes are aligned to 8.
// Errors: corrupt, naming the paragraph broken.
Result<TrackletTile> tile_from_table(ByteView bytes);

}  // namespace milepost
