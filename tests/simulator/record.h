// Drives along a simulated street, recorded into drive folders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "tests/simulator/street.h"

namespace milepost::simulator {

// The camera of the tracklet paper.
inline constexpr Camera kPaperCamera{600, 500, 357.5, 400.1, 300, 250};

// How a vehicle drives along a street and what its sensors add.
struct RunPlan {
  std::string name;
  Camera camera = kPaperCamera;
  double from_m = 0;  // along the street
  double to_m = 120;  // frames stand at from_m, from_m + spacing_m, ... below to_m
  double spacing_m = 2;
  double speed_mps = 10;
  double start_s = 0;             // time of the first frame
  double lateral_m = 1.75;        // from the middle line, positive to the right
  double wander_m = 0;            // amplitude of a slow swing about lateral_m
  double heading_jitter_deg = 0;  // standard deviations, frame by frame
  double pitch_jitter_deg = 0;
  double gain = 1;            // brightness
  double image_noise = 2;     // standard deviation, in grey levels
  bool has_receiver = false;  // writes gps.csv, 1 Hz
  bool has_odometer = false;  // writes odometry.csv, 10 Hz
  std::uint64_t seed = 1;     // of everything random in the run
};

// The two runs of the command and of most tests: a mapping drive with a frame every 2 m, and a
// later drive by another line, with other noise, a receiver and an odometer.
RunPlan map_run(const StreetPlan& plan);
RunPlan query_run(const StreetPlan& plan);

// Called before each frame with its index and the number of frames.
using Progress = std::function<void(std::size_t, std::size_t)>;

// Renders the run's frames and writes the drive into `folder`; tables come last, so a folder
// that was not finished is no drive. The same street and run give the same bytes.
// Errors: io; invalid_input for a run that is no drive (no frame, no spacing, no speed).
Status record(const Street& street, const RunPlan& run, const std::filesystem::path& folder,
              const Progress& progress = {});

}  // namespace milepost::simulator
