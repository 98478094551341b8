#include <cmath>
#include <cstdlib>

#include "schema/tile/columns.h"
#include "schema/tile/table.h"
#include "schema/tile/wall_steps.h"
#include "schema/tile/wall_tile_generated.h"

namespace milepost {
namespace {

constexpr const char* kNotWalls = "the content is not a valid FlatBuffer with the identifier MPW1";

flatbuffers::Offset<fbs::WallTile> build_table(flatbuffers::FlatBufferBuilder& builder,
                                               const WallTile& tile) {
  const auto walls =
      column<WallSteps>(tile.walls, [&](auto& wall) { return steps_of(wall, tile.cell); });
  const auto array = [&](auto value_of_wall) {
    using Value = std::remove_cvref_t<decltype(value_of_wall(walls.front()))>;
    return builder.CreateVector(column<Value>(walls, value_of_wall));
  };
  // Separate statements: the order of evaluation of arguments, and so of the bytes, is unspecified.
  const auto begin_north = array([](auto& wall) { return wall.begin_north; });
  const auto begin_east = array([](auto& wall) { return wall.begin_east; });
  const auto way_north = array([](auto& wall) { return wall.way_north; });
  const auto way_east = array([](auto& wall) { return wall.way_east; });
  const auto sigma_cm = array([](auto& wall) { return wall.sigma_cm; });
  return fbs::CreateWallTile(builder, tile.cell, begin_north, begin_east, way_north, way_east,
                             sigma_cm);
}

Status check_arrays(const fbs::WallTile& table, const std::string& where) {
  const std::size_t count = table.begin_north()->size();
  if (count > kMaxWallsPerTile) return broken_tile(where, "more than 65536 walls", "6.4");
  return check_lengths(where, {"begin_north", count},
                       {{"begin_east", table.begin_east()->size()},
                        {"way_north", table.way_north()->size()},
                        {"way_east", table.way_east()->size()},
                        {"sigma_cm", table.sigma_cm()->size()}},
                       "6.4");
}

// The steps are range-checked before they are added, and so is every sum.
Status check_wall(const WallSteps& steps, std::uint32_t cell, const std::string& where) {
  for (const std::int64_t way : {steps.way_north, steps.way_east}) {
    if (std::abs(way) > kMaxWallSteps) {
      return broken_tile(where, "the wall spans more than 0.1 degrees", "6.4");
    }
  }
  const Wall wall = wall_of(steps, cell);
  const Bounds box = bounds_of(wall);
  if (box.south_deg < -90 || box.north_deg > 90 || box.west_deg < -180 || box.east_deg > 180) {
    return broken_tile(where, "a latitude or longitude is out of range", "6.4");
  }
  if (!box.meets(GridCell::numbered(cell).bounds())) {
    return broken_tile(where, "the wall lies outside its cell", "6.4");
  }
  if (steps.sigma_cm == 0) return broken_tile(where, "the sigma is 0", "6.5");
  return ok_status();
}

}  // namespace

Bytes table_from_walls(const WallTile& tile) {
  flatbuffers::FlatBufferBuilder builder;
  fbs::FinishSizePrefixedWallTileBuffer(builder, build_table(builder, tile));
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<WallTile> walls_from_table(ByteView bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (!fbs::VerifySizePrefixedWallTileBuffer(verifier)) {
    return broken_tile("cell", kNotWalls, "6.3");
  }
  const fbs::WallTile& table = *fbs::GetSizePrefixedWallTile(bytes.data());
  const std::string where = "cell " + std::to_string(table.cell());
  if (!is_cell(table.cell())) return broken_tile(where, "there is no such cell", "6.1");
  Status status = check_arrays(table, where);
  if (!status.ok()) return status.error();

  WallTile tile{table.cell(), {}};
  const flatbuffers::uoffset_t count = table.begin_north()->size();
  tile.walls.reserve(count);
  for (flatbuffers::uoffset_t i = 0; i < count; ++i) {
    const WallSteps steps{table.begin_north()->Get(i), table.begin_east()->Get(i),
                          table.way_north()->Get(i), table.way_east()->Get(i),
                          table.sigma_cm()->Get(i)};
    status = check_wall(steps, tile.cell, where + ", wall " + std::to_string(i));
    if (!status.ok()) return status.error();
    tile.walls.push_back(wall_of(steps, tile.cell));
  }
  return tile;
}

}  // namespace milepost
