// drive -> features per frame -> tracks -> tracklets -> tiles -> map file.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mapper/acceptance/check_points.h"
#include "mapper/findings/finding.h"
#include "mapper/landmarks/adjustment.h"
#include "mapper/pipeline/divided_map.h"
#include "mapper/pipeline/settings.h"
#include "schema/base/result.h"
#include "schema/document/mapping_record.h"
#include "schema/drive/drive.h"

namespace milepost {

struct BuildProgress {
  std::size_t frames_done = 0;
  std::size_t frames_total = 0;
};

// Statistics of one drive.
struct DriveReport {
  std::string folder;
  std::size_t frames = 0;  // that were processed
  std::size_t features = 0;
  std::size_t tracklets = 0;  // landmarks that were mapped
  int darkest = 255;          // of the frames' grey values, 0 to 255
  int brightest = 0;
  ImageWitness witness = {};  // what its images say of its poses
};

// What is held against a map, and recorded in it beside what the build finds.
struct BuildChecks {
  std::vector<Finding> found_before;     // about the drives alone
  std::vector<CheckPoint> check_points;  // surveyed marks
  std::optional<double> max_check_m;     // root mean square in plan; the build fails beyond it
};

struct BuildReport {
  std::vector<MapReport> maps;      // one, or one on either side of the border
  std::vector<DriveReport> drives;  // by name
  std::vector<Finding> findings;    // about the drives and their network
  std::vector<CheckPointResidual> check_points;
  std::size_t frames = 0;
};

// The error for a drive without tracklets, with its statistics.
Error nothing_found(const DriveReport& drive);

// Builds `map_file` from the drives, which make one road network. The map's bytes depend only on
// drives and settings, not on the order of the drives. `on_progress` is called after each frame,
// from this thread; the build ends with `cancelled` once it returns false. `map_file`, and the map
// beyond a border, are created or replaced only after success. Errors: invalid_input, also for a
// drive without any tracklet unless the settings allow it, and for check points that are too far
// off; io; cancelled.
Result<BuildReport> build_map(const std::vector<Drive>& drives,
                              const std::filesystem::path& map_file, const BuildSettings& settings,
                              int jobs,
                              const std::function<bool(const BuildProgress&)>& on_progress,
                              const BuildChecks& checks = {});

}  // namespace milepost
