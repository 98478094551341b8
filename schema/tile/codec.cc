#include "schema/tile/codec.h"

#include "schema/tile/table.h"
#include "schema/tile/zstd_frame.h"

namespace milepost {
namespace {

template <class Tile>
Result<Tile> decode(ByteView frame, Result<Tile> (*from_table)(ByteView)) {
  const Result<Bytes> content = expand_frame(frame);
  if (!content) return content.error();
  return from_table(*content);
}

}  // namespace

Bytes encode_tile(const TrackletTile& tile) { return compress_frame(table_from_tile(tile)); }

Bytes encode_observations(const ObservationTile& tile) {
  return compress_frame(table_from_observations(tile));
}

Bytes encode_frames(const ImageDescriptorTile& tile) {
  return compress_frame(table_from_frames(tile));
}

Bytes encode_landmarks(const LandmarkTile& tile) {
  const Bytes table = table_from_landmarks(tile);
  return compress_frame(table, landmark_array_starts(table));
}

Bytes encode_walls(const WallTile& tile) { return compress_frame(table_from_walls(tile)); }

Result<TrackletTile> decode_tile(ByteView frame) { return decode(frame, tile_from_table); }

Result<ObservationTile> decode_observations(ByteView frame) {
  return decode(frame, observations_from_table);
}

Result<ImageDescriptorTile> decode_frames(ByteView frame) {
  return decode(frame, frames_from_table);
}

Result<LandmarkTile> decode_landmarks(ByteView frame) {
  return decode(frame, landmarks_from_table);
}

Result<WallTile> decode_walls(ByteView frame) { return decode(frame, walls_from_table); }

Result<std::size_t> stored_frame_length(ByteView stream) { return frame_length(stream); }

}  // namespace milepost
