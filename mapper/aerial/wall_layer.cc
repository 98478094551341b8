#include "mapper/aerial/wall_layer.h"

#include <nlohmann/json.hpp>

#include "mapper/aerial/storable_walls.h"
#include "schema/geo/geodesy.h"
#include "schema/store/map_store.h"
#include "schema/tile/codec.h"
#include "schema/tile/table.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxCopies = 20'000'000;  // of walls, in all cells after their first

Status copy_segment(const MapReader& from, const std::string& id, MapWriter& to) {
  const Result<StoredSegment> segment = from.segment(id);
  if (!segment) return segment.error();
  if (const Status status = to.add_segment(*segment); !status) return status;
  for (const auto& [layer, parameters] : from.layers()) {
    const Result<std::vector<TileEntry>> index = from.tile_index(id, layer);
    if (!index) return index.error();
    for (const TileEntry& tile : *index) {
      const Result<Bytes> frame = from.tile(id, layer, tile.index);
      if (!frame) return frame.error();
      const Status status = to.add_tile(id, layer, tile.index, tile.along, tile.items, *frame);
      if (!status) return status;
    }
  }
  return ok_status();
}

Status copy_cells(const MapReader& from, const std::string& layer, MapWriter& to) {
  const Result<std::vector<CellEntry>> index = from.cell_index(layer);
  if (!index) return index.error();
  for (const CellEntry& cell : *index) {
    const Result<Bytes> frame = from.cell(layer, cell.cell);
    if (!frame) return frame.error();
    const Status status = to.add_cell(layer, cell.cell, cell.items, *frame);
    if (!status) return status;
  }
  return ok_status();
}

// Copies everything except the walls.
Status copy_others(const MapReader& from, MapWriter& to) {
  const Result<std::string> mapping = from.mapping_document();
  if (!mapping) return mapping.error();
  Status status = to.set_feature_json(from.feature_json());
  if (status) status = to.set_datum(from.datum());
  if (status) status = to.set_mapping_document(*mapping);
  if (!status) return status;
  for (const auto& [layer, parameters] : from.layers()) {
    if (layer == layers::kWalls) continue;
    if (status = to.add_layer(layer, parameters); !status) return status;
    if (status = copy_cells(from, layer, to); !status) return status;
  }
  for (const std::string& id : from.segment_ids()) {
    if (status = copy_segment(from, id, to); !status) return status;
  }
  return ok_status();
}

// Rejects what a reader would reject. Errors: those of decode_walls.
Status check_readable(const Bytes& frame, const fs::path& map_file) {
  const Result<WallTile> tile = decode_walls(frame);
  if (tile) return ok_status();
  return Error{ErrorCode::invalid_input, map_file.string() + ", " + tile.error().where,
               "it would not be readable: " + tile.error().what,
               "leave out the part of the image or of the footprints that lies there"};
}

Status add_walls(const std::vector<WallTile>& tiles, const fs::path& map_file, MapWriter& to) {
  for (const WallTile& tile : tiles) {
    if (tile.walls.size() > kMaxWallsPerTile) {
      return Error{ErrorCode::invalid_input,
                   map_file.string() + ", cell " + std::to_string(tile.cell),
                   "it would hold " + std::to_string(tile.walls.size()) + " walls, more than " +
                       std::to_string(kMaxWallsPerTile),
                   "require longer lines (--min-length-m)"};
    }
    const Bytes frame = encode_walls(tile);
    if (const Status status = check_readable(frame, map_file); !status) return status;
    const Status status = to.add_cell(layers::kWalls, tile.cell, tile.walls.size(), frame);
    if (!status) return status;
  }
  return ok_status();
}

std::size_t cells_of(const Wall& wall) {
  const Bounds box = bounds_of(wall);
  const GridCell first = GridCell::at(box.south_deg, box.west_deg);
  const GridCell last = GridCell::at(box.north_deg, box.east_deg);
  return std::size_t{last.row - first.row + 1} * (last.column - first.column + 1);
}

// Checks that the tiles fit into memory: a wall is stored whole in each cell that its box meets.
Status check_copies(const std::vector<Wall>& walls, const fs::path& map_file) {
  std::size_t copies = 0;
  for (const Wall& wall : walls) copies += cells_of(wall) - 1;
  if (copies <= kMaxCopies) return ok_status();
  return Error{ErrorCode::invalid_input, map_file.string(),
               "its walls are so long that their cells would hold " +
                   std::to_string(copies + walls.size()) + " of them",
               "leave out outlines that are not of buildings"};
}

double total_length_m(const std::vector<Wall>& walls) {
  double length_m = 0;
  for (const Wall& wall : walls) {
    length_m += geodesic_distance_m({wall.begin.latitude_deg, wall.begin.longitude_deg, 0},
                                    {wall.end.latitude_deg, wall.end.longitude_deg, 0});
  }
  return length_m;
}

}  // namespace

Result<WallLayerReport> write_wall_layer(const fs::path& map_file, const std::vector<Wall>& walls,
                                         const WallLayerParameters& parameters) {
  const Result<std::vector<Wall>> storable = storable_walls(walls);
  if (!storable) return storable.error();
  if (const Status status = check_copies(*storable, map_file); !status) return status.error();
  Result<MapWriter> writer = MapWriter::create(map_file);
  if (!writer) return writer.error();
  std::error_code ignored;
  if (fs::exists(map_file, ignored)) {
    const Result<MapReader> old = MapReader::open(map_file);
    if (!old) return old.error();
    if (const Status status = copy_others(*old, *writer); !status) return status.error();
  }
  // A file's name may not be valid UTF-8.
  const std::string parameters_text =
      to_json(parameters).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  if (const Status status = writer->add_layer(layers::kWalls, parameters_text); !status) {
    return status.error();
  }
  const std::vector<WallTile> tiles = tiles_of(*storable);
  if (const Status status = add_walls(tiles, map_file, *writer); !status) return status.error();
  Result<std::string> build = writer->finish();
  if (!build) return build.error();
  return WallLayerReport{std::move(*build), storable->size(), total_length_m(*storable),
                         tiles.size()};
}

}  // namespace milepost
