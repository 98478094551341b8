// The drives that are recorded in a town: route, time of day and driving style.
#pragma once

#include <string>
#include <vector>

#include "schema/drive/drive.h"
#include "tests/simulator/light.h"
#include "tests/simulator/motion.h"
#include "tests/simulator/network.h"

namespace milepost::simulator {

// The camera of the tracklet paper: 600 x 500 pixels, 80 x 64 degrees.
inline constexpr Camera kPaperCamera{600, 500, {357.5, 400.1, 300, 250}};

// Standard deviations of the errors of the positions that a drive's file states. The frames are
// taken at the true ones.
struct PositionErrors {
  double noise_m = 0;      // on each axis, from frame to frame
  double drift_m = 0;      // on each axis, over some 100 to 300 m
  double bias_m = 0;       // on each axis, of the whole drive
  double heading_deg = 0;  // from frame to frame
};

struct RunPlan {
  std::string name;
  std::string route;
  bool backwards = false;  // drives the route from its end to its start
  std::string says;        // one line of description
  Camera camera = kPaperCamera;
  MotionPlan motion;     // along path_of()
  double spacing_m = 0;  // between frames; 0: frames come by time
  double frame_period_s = 0.2;
  double period_jitter_s = 0;     // standard deviation
  double dropped_share = 0;       // share of lost frames, [0, 1)
  double heading_jitter_deg = 0;  // standard deviations, frame by frame
  double pitch_jitter_deg = 0;
  double roll_jitter_deg = 0;
  double position_noise_m = 0;  // of the positions written, slowly changing
  PositionErrors errors;        // further ones
  Light light;
  double image_noise = 2;  // standard deviation, in grey levels
  bool has_truck_ahead = false;
  bool has_oncoming = false;
  bool has_receiver = false;   // writes gps.csv, 1 Hz
  bool has_odometer = false;   // writes odometry.csv, 10 Hz
  bool keeps_frames = false;   // does not render again what is in the folder already
  bool records_tilts = false;  // pitch and roll, in further columns of trajectory.csv
  bool states_lanes = false;   // in the further columns `road` and `lane` of trajectory.csv
  std::uint64_t seed = 1;      // of everything random in the run
};

// Frames by time, some of them late or lost, from a camera that shakes and whose pictures are
// noisier.
void be_driven_by_another(RunPlan& run);

// The path of a run. REQUIRES: the network has its route.
Path path_of(const Network& network, const RunPlan& run);

// All drives of all routes, each route's mapping drive first. `length_m` limits each route.
std::vector<RunPlan> make_runs(const Network& network, std::uint64_t seed, double length_m);

// Whether the route is driven if none is requested.
bool is_driven_by_default(const std::string& route);

}  // namespace milepost::simulator
