// A tile's content: the FlatBuffers tables of tile.fbs (FORMAT.md 3.3 to 3.10) and of the other
// kinds of tiles (4 to 6), size-prefixed.
#pragma once

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/tile/database_frame.h"
#include "schema/tile/landmark.h"
#include "schema/tile/observation.h"
#include "schema/tile/tracklet.h"
#include "schema/tile/wall.h"

namespace milepost {

inline constexpr std::size_t kMaxTrackletsPerTile = 65536;
inline constexpr std::size_t kMaxLandmarksPerTile = 65536;
inline constexpr std::size_t kMaxWallsPerTile = 65536;

// Deterministic: equal tiles give equal bytes. REQUIRES: as encode_tile.
Bytes table_from_tile(const TrackletTile& tile);
Bytes table_from_observations(const ObservationTile& tile);
Bytes table_from_frames(const ImageDescriptorTile& tile);
Bytes table_from_landmarks(const LandmarkTile& tile);
Bytes table_from_walls(const WallTile& tile);

// The offsets of the three planar arrays in a table of table_from_landmarks, ascending.
std::vector<std::size_t> landmark_array_starts(ByteView bytes);

// The input is untrusted. REQUIRES: the bytes are aligned to 8.
// Errors: corrupt, naming the violated paragraph.
Result<TrackletTile> tile_from_table(ByteView bytes);
Result<ObservationTile> observations_from_table(ByteView bytes);
Result<ImageDescriptorTile> frames_from_table(ByteView bytes);
Result<LandmarkTile> landmarks_from_table(ByteView bytes);
Result<WallTile> walls_from_table(ByteView bytes);

}  // namespace milepost
