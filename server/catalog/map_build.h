// One build of a map: what the catalog keeps of it. The rest is in its file, and in memory while it
// is asked for (open_maps.h).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "schema/store/held_file.h"
#include "server/catalog/map_lines.h"

namespace milepost::server {

struct MapBuild {
  std::string map;  // its name
  std::string build;
  std::optional<Bounds> bounds;           // of the lines; nothing without segments
  std::shared_ptr<const MapLines> lines;  // null where lines are more than may be kept in memory
  std::filesystem::path file;
  FileIdentity identity;
  // Null where files are more than may be held open: the path is opened again, as long as it leads
  // to the same file.
  std::shared_ptr<const HeldFile> held;
};

}  // namespace milepost::server
