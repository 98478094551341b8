#include "schema/tile/codec.h"

#include "schema/tile/frame.h"
#include "schema/tile/table.h"

namespace milepost {

Bytes encode_tile(const TrackletTile& tile) { return compress_frame(table_from_tile(tile)); }

Result<TrackletTile> decode_tile(ByteView frame) {
  const Result<Bytes> content = expand_frame(frame);
  if (!content) return content.error();
  return tile_from_table(*content);
}

Result<std::size_t> stored_frame_length(ByteView stream) { return frame_length(stream); }

}  // namespace milepost
