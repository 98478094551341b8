// A recording of another program as a drive folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapper/import/recording.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

struct DriveSettings {
  std::filesystem::path folder;             // of the drive; new, or empty
  std::string name;                         // empty: the folder's
  std::string source;                       // one line
  bool copy_images = false;                 // otherwise they are referred to by symbolic links
  double day_s = 0;                         // added to the poses' times
  double time_offset_s = 0;                 // added to the images'
  std::optional<double> estimate_offset_s;  // find out more of it by the motion, up to so much
  double max_gap_s = 1;                     // between poses; images in longer gaps are left out
  bool spread_seconds = false;              // images stamped with whole seconds
  std::optional<Camera> camera;             // in the place of the recording's
  std::optional<Mounting> mounting;
  Datum datum;     // of the recorded positions, in the place of the recording's
  Datum to_datum;  // transforms them
  std::optional<double> receiver_sigma_m;  // also writes gps.csv, one position a second
};

struct ImportReport {
  Drive drive;                     // as it is read back
  std::vector<std::string> notes;  // what was left out and why, a line each
};

// Writes the drive and reads it back. A failure leaves none behind. Errors: invalid_input (no
// camera, no image with a pose, what read_drive refuses), io.
Result<ImportReport> import_drive(Recording recording, const DriveSettings& settings);

}  // namespace milepost
