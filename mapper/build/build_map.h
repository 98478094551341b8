// drive -> features per frame -> tracks -> tracklets -> tiles -> map file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mapper/build/settings.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

struct BuildProgress {
  std::size_t frames_done = 0;
  std::size_t frames_total = 0;
};

struct BuildReport {
  std::string build;
  std::size_t segments = 0;
  std::size_t frames = 0;
  std::size_t tiles = 0;
  std::size_t tracklets = 0;         // of the layer `tracklets`
  std::uint64_t tracklet_bytes = 0;  // of its tiles
  double length_m = 0;
};

// Makes `map_file` from the drives, each one segment named after its drive. The map's bytes depend
// on drives and settings only. `on_progress` is called after each frame, from this thread; the
// build ends with `cancelled` once it returns false. Until all is done, nothing appears at
// `map_file`, and a map that was there stays. Errors: invalid_input, io, cancelled.
Result<BuildReport> build_map(const std::vector<Drive>& drives,
                              const std::filesystem::path& map_file, const BuildSettings& settings,
                              int jobs,
                              const std::function<bool(const BuildProgress&)>& on_progress);

}  // namespace milepost
