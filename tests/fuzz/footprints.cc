// Footprints with arbitrary bytes: walls that are read from them can be stored, and read again.
#include "mapper/aerial/footprints.h"

#include <cstdint>

#include "mapper/aerial/storable_walls.h"
#include "schema/tile/codec.h"
#include "tests/fuzz/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace milepost;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<Footprints> footprints = footprints_in(text, "fuzz");
  if (!footprints) {
    fuzz::check(footprints.error().code == ErrorCode::invalid_input);
    return 0;
  }
  const Result<std::vector<Wall>> walls = storable_walls(footprints->walls);
  fuzz::check(walls.ok());
  for (const WallTile& tile : tiles_of(*walls)) {
    fuzz::check(decode_walls(encode_walls(tile)).ok());
  }
  return 0;
}
