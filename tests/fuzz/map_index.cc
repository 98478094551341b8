// A map file with arbitrary bytes: the reads of a client ('c' as the first byte), or of a server
// at its start ('s').
#include <cstdint>
#include <memory>
#include <utility>

#include "schema/store/map_store.h"
#include "schema/tile/codec.h"
#include "server/catalog/served_map.h"
#include "tests/fuzz/check.h"
#include "tests/fuzz/scratch_file.h"

namespace {

using namespace milepost;

void read_segment(const MapReader& map, const std::string& id) {
  static_cast<void>(map.segment(id));
  for (const auto& [layer, parameters] : map.layers()) {
    const Result<std::vector<TileEntry>> index = map.tile_index(id, layer);
    static_cast<void>(map.tiles_in(id, layer, {0, 100}));
    if (!index) continue;
    for (const TileEntry& entry : *index) static_cast<void>(map.tile(id, layer, entry.index));
  }
}

void read_cells(const MapReader& map, const std::string& layer) {
  const Result<std::vector<CellEntry>> cells = map.cell_index(layer);
  if (!cells) return;
  for (const CellEntry& entry : *cells) {
    fuzz::check(is_cell(entry.cell));
    const Result<Bytes> frame = map.cell(layer, entry.cell);
    if (frame) static_cast<void>(decode_walls(*frame));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const fuzz::ScratchFile file(".map");
  file.write(data + 1, size - 1);
  if (data[0] == 's') {
    Result<HeldFile> opened = HeldFile::open(file.path());
    fuzz::check(opened.ok());
    const auto held = std::make_shared<const HeldFile>(std::move(*opened));
    static_cast<void>(
        server::ServedMap::open("fuzz", held, 1, std::make_shared<server::MapFaults>()));
    return 0;
  }
  const Result<MapReader> map = MapReader::open(file.path());
  if (!map) return 0;
  for (const std::string& id : map->segment_ids()) read_segment(*map, id);
  for (const auto& [layer, parameters] : map->layers()) read_cells(*map, layer);
  static_cast<void>(map->verify());
  return 0;
}
