// drive -> features per frame -> tracks -> tracklets -> tiles -> map file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mapper/pipeline/settings.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

struct BuildProgress {
  std::size_t frames_done = 0;
  std::size_t frames_total = 0;
};

// What was found in one drive.
struct DriveReport {
  std::string folder;
  std::size_t frames = 0;  // that were looked at
  std::size_t features = 0;
  std::size_t tracklets = 0;  // of the layer `tracklets`
  int darkest = 255;          // of the frames' grey values, 0 to 255
  int brightest = 0;
};

struct BuildReport {
  std::string build;
  std::vector<DriveReport> drives;  // one a segment
  std::size_t frames = 0;
  std::size_t tiles = 0;
  std::size_t tracklets = 0;         // of the layer `tracklets`
  std::uint64_t tracklet_bytes = 0;  // of its tiles
  double length_m = 0;
};

// That no tracklet was found in the drive, and what else was.
Error nothing_found(const DriveReport& drive);

// Makes `map_file` from the drives, each one segment named after its drive. The map's bytes depend
// on drives and settings only. `on_progress` is called after each frame, from this thread; the
// build ends with `cancelled` once it returns false. Until all is done, nothing appears at
// `map_file`, and a map that was there stays. Errors: invalid_input, also for a drive without any
// tracklet unless the settings allow it; io; cancelled.
Result<BuildReport> build_map(const std::vector<Drive>& drives,
                              const std::filesystem::path& map_file, const BuildSettings& settings,
                              int jobs,
                              const std::function<bool(const BuildProgress&)>& on_progress);

}  // namespace milepost
