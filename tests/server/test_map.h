// A small map in a folder of its own, written by MapWriter.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "schema/document/mapping_record.h"
#include "schema/store/map_store.h"
#include "schema/tile/landmark.h"
#include "schema/tile/wall.h"
#include "server/catalog/catalog.h"

namespace milepost::server {

// A folder that is removed with the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The cell whose south-west corner is 49 N 8 E, the one to its east and the one to its north.
inline constexpr std::uint32_t kTownCells[] = {
    27800 * kCellColumns + 37600, 27800 * kCellColumns + 37601, 27801 * kCellColumns + 37600};

// Segment "s1" runs north from 49 N 8 E for 200 m, "s2" east from there. Layer "tracklets" has
// tiles 0 to 3 on s1 ([0, 60], [50, 110], [100, 160], [150, 200]) and none on s2; layer "walls" has
// no tile, but kTownCells.
struct TownMap {
  std::string build;
  std::vector<Bytes> frames;  // of s1's tracklets, by index
  std::vector<Bytes> cells;   // of kTownCells
};

// Writes the map. `frame_bytes` is the length of each encoded tile, whose content is arbitrary and
// differs with `seed`.
TownMap write_town(const std::filesystem::path& file, std::size_t frame_bytes = 1000,
                   unsigned seed = 1);

// Writes the town with 77 other bytes for tile 1 of s1, without its tile 3, and without s2. Returns
// the build.
std::string write_changed_town(const std::filesystem::path& file, const TownMap& town);

// Segment "s1" of the town with a tile 0 of layer "tracklets" and the first of kTownCells, which
// can be decoded, and with a record of its mapping.
struct LaneMap {
  std::string build;
  LandmarkTile landmarks;
  WallTile walls;
  MappingRecord mapping;
};

// Writes the map with so many landmarks: each a metre north of the one before, 2 m above the line.
LaneMap write_lane(const std::filesystem::path& file, std::size_t landmarks = 3);

// Writes a map with nothing but a layer "walls" of these cells, each of them four bytes.
// Returns its build.
std::string write_walls(const std::filesystem::path& file, const std::vector<std::uint32_t>& cells);

// The map of a catalog that has it, read from its file if need be.
std::shared_ptr<const ServedMap> served_map(const Catalog& catalog, const std::string& name);

// Opens a catalog, which must be valid.
std::shared_ptr<const Catalog> open_catalog(const std::filesystem::path& folder,
                                            unsigned readers = 2);

}  // namespace milepost::server
