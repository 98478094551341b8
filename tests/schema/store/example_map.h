// A small map on the disk for the tests of the store.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "schema/base/bytes.h"
#include "schema/store/map_store.h"

namespace milepost::testing {

// The cell at latitude 49.1, longitude 8.5 and two neighbours.
inline constexpr std::uint32_t kCells[] = {
    27820 * kCellColumns + 37700, 27820 * kCellColumns + 37701, 27821 * kCellColumns + 37700};

// A line with the minimum of two vertices.
inline const std::vector<StoredVertex> kShortLine = {{49, 8, 100, 0}, {49.1, 8, 100, 1}};

// Reproducible incompressible bytes, like those of an encoded tile.
Bytes tile_bytes(std::size_t size, std::uint32_t seed);

// Two segments, "east" and "west" (passes, a successor in another map and a position error on
// "east" only), and two layers, "tracklets" and "walls". On "east" tile i of
// "tracklets" (0 to 9) reaches from 10 i to 10 i + 25 m; tile 3 reaches further, to 80 m. "walls"
// also has three cells: at kCells[0], right of it, and one row above.
void add_example(MapWriter& writer);

// The example's map as a file; returns its build.
std::string write_example(const std::filesystem::path& file);

std::string content_of(const std::filesystem::path& file);

}  // namespace milepost::testing
