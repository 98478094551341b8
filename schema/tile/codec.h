// Encodes and decodes tiles: FlatBuffers (tile.fbs and the like), size-prefixed, in one zstd frame
// with checksum. FORMAT.md 3 to 6 specify the layout; messages name their paragraphs.
#pragma once

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/tile/database_frame.h"
#include "schema/tile/landmark.h"
#include "schema/tile/observation.h"
#include "schema/tile/tracklet.h"
#include "schema/tile/wall.h"

namespace milepost {

// Deterministic: equal tiles give equal bytes.
// REQUIRES: every item satisfies the ranges of FORMAT.md (checked in decode).
Bytes encode_tile(const TrackletTile& tile);
Bytes encode_observations(const ObservationTile& tile);
Bytes encode_frames(const ImageDescriptorTile& tile);
Bytes encode_landmarks(const LandmarkTile& tile);
Bytes encode_walls(const WallTile& tile);

// The input is untrusted. Errors: corrupt, naming the violated paragraph.
Result<TrackletTile> decode_tile(ByteView frame);
Result<ObservationTile> decode_observations(ByteView frame);
Result<ImageDescriptorTile> decode_frames(ByteView frame);
Result<LandmarkTile> decode_landmarks(ByteView frame);
Result<WallTile> decode_walls(ByteView frame);

// The length of the zstd frame at the start of `stream`, to split a response to a range request
// into tiles; 0 if the stream ends inside the frame. Errors: corrupt (not a zstd frame).
Result<std::size_t> stored_frame_length(ByteView stream);

}  // namespace milepost
