// A drive: one recorded run of a camera vehicle (the folder is described in design and FORMAT.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "schema/base/result.h"
#include "schema/geo/camera.h"
#include "schema/geo/datum.h"
#include "schema/geo/geodesy.h"
#include "schema/geo/odometry.h"

namespace milepost {

struct Frame {
  std::string filename;  // inside the drive's image folder
  double timestamp_s = 0;
  GeoPoint position;       // of the camera
  double heading_deg = 0;  // of the camera, clockwise from north, [0, 360) when read
  double pitch_deg = 0;    // of the camera, upwards; of a level vehicle where it is not recorded
  double roll_deg = 0;     // the same, clockwise as seen by the driver
  std::size_t line = 0;    // of trajectory.csv, for messages; 0 when the frame was not read
  std::optional<double> position_sigma_m = {};  // stated for this frame, as below
};

// What a drive states of the errors of its recorded positions.
struct StatedPositionError {
  std::optional<double> sigma_m = {};        // standard deviation on each axis, 0 to 1000
  std::optional<double> correlation_m = {};  // of what changes along the way, 1 to 100000
  std::string group = {};  // drives that name the same one share a constant error; may be empty
};

struct GpsFix {
  double timestamp_s = 0;
  GeoPoint position;  // altitude 0
  double sigma_m = 0;
};

enum class PositionFrame { local, geographic };

struct Drive {
  std::filesystem::path folder;
  std::string name;
  Camera camera;
  PositionFrame position_frame = PositionFrame::geographic;
  std::optional<GeoPoint> origin;  // of a local frame
  Datum datum;                     // of all positions
  std::string images;              // folder of the frames inside `folder`
  std::string captured;
  std::string licence;
  std::string source;
  StatedPositionError position_error;
  bool has_tilts = false;          // whether the frames' pitch and roll are recorded
  std::vector<Frame> frames;       // timestamps ascend strictly; all state a sigma or none
  std::vector<GpsFix> gps;         // empty without gps.csv; timestamps ascend strictly
  std::vector<Odometry> odometry;  // empty without odometry.csv; the same

  std::filesystem::path frame_path(const Frame& frame) const {
    return folder / images / frame.filename;
  }
};

// A higher speed between two rows is reported as a position jump.
inline constexpr double kMaxSpeedMps = 70.0;

// Reads and checks a drive folder; the frames' images must exist but are not opened.
// Errors (each names file, line and hint): a missing file, a wrong header, a number that is not
// finite or out of range, time that does not increase, a position jump, no frame at all.
Result<Drive> read_drive(const std::filesystem::path& folder);

// Every file of the drive: its description, its tables, which need not all exist, and the images
// of its frames.
std::vector<std::filesystem::path> files_of(const Drive& drive);

// Writes drive.json, trajectory.csv and, where there are readings, gps.csv and odometry.csv into
// `folder`, which is created if missing; the caller writes the images. Errors: io, invalid_input.
Status write_drive(const Drive& drive, const std::filesystem::path& folder);

}  // namespace milepost
