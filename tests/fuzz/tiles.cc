// The tile decoders. The first byte chooses one: a capital letter for an encoded tile, a lower-case
// letter for its content, which zstd's checksum would otherwise protect.
#include <cstdint>

#include "schema/tile/codec.h"
#include "schema/tile/table.h"
#include "tests/fuzz/check.h"

namespace {

using namespace milepost;

template <class Tile>
Result<Tile> read(ByteView bytes, Result<Tile> (*from_table)(ByteView)) {
  const Bytes table(bytes.begin(), bytes.end());  // aligned
  Result<Tile> tile = from_table(table);
  fuzz::check(tile.ok() || tile.error().code == ErrorCode::corrupt);
  return tile;
}

// A tile with quantized values: a tile that is accepted can be encoded, and is accepted again.
template <class Tile>
void read_twice(ByteView bytes, Result<Tile> (*from_table)(ByteView),
                Bytes (*table_from)(const Tile&)) {
  const Result<Tile> tile = read(bytes, from_table);
  if (tile) fuzz::check(from_table(table_from(*tile)).ok());
}

template <class Tile>
void decode(ByteView bytes, Result<Tile> (*decode_frame)(ByteView)) {
  const Result<Tile> tile = decode_frame(bytes);
  fuzz::check(tile.ok() || tile.error().code == ErrorCode::corrupt);
}

void read_as(char kind, ByteView bytes) {
  switch (kind) {
    case 't':
      return static_cast<void>(read(bytes, tile_from_table));
    case 'o':
      return static_cast<void>(read(bytes, observations_from_table));
    case 'f':
      return static_cast<void>(read(bytes, frames_from_table));
    case 'l':
      return read_twice(bytes, landmarks_from_table, table_from_landmarks);
    case 'w':
      return read_twice(bytes, walls_from_table, table_from_walls);
    case 'T':
      return decode(bytes, decode_tile);
    case 'O':
      return decode(bytes, decode_observations);
    case 'F':
      return decode(bytes, decode_frames);
    case 'L':
      return decode(bytes, decode_landmarks);
    case 'W':
      return decode(bytes, decode_walls);
    default:
      static_cast<void>(stored_frame_length(bytes));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) read_as(static_cast<char>(data[0]), {data + 1, size - 1});
  return 0;
}
