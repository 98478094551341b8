// A small map in a folder of its own, written by MapWriter.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "schema/store/map_store.h"
#include "server/catalog/catalog.h"

namespace milepost::server {

// A folder that goes away with the test.
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

// Segment "s1" runs north from 49 N 8 E for 200 m, "s2" east from there. Layer "tracklets" has
// tiles 0 to 3 on s1 ([0, 60], [50, 110], [100, 160], [150, 200]) and none on s2; layer "walls" has
// no tile.
struct TownMap {
  std::string build;
  std::vector<Bytes> frames;  // of s1's tracklets, by index
};

// Writes the map. `frame_bytes` is the length of each stored frame, whose content is arbitrary and
// differs with `seed`.
TownMap write_town(const std::filesystem::path& file, std::size_t frame_bytes = 1000,
                   unsigned seed = 1);

// Opens a catalog that must be good.
std::shared_ptr<const Catalog> open_catalog(const std::filesystem::path& folder,
                                            unsigned readers = 2);

}  // namespace milepost::server
