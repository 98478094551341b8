#include "tests/simulator/city_runs.h"

#include <algorithm>

namespace milepost::simulator {
namespace {

// What differs from one drive to the next, in turn.
Light light_of(std::size_t drive) {
  Light light = drive % 4 == 0   ? noon_light()
                : drive % 4 == 1 ? afternoon_light()
                : drive % 4 == 2 ? overcast_light()
                                 : morning_light();
  light.clouds_seed = drive + 1;
  return light;
}

RunPlan run_of(const City& city, std::size_t index, double length_m) {
  const CityDrive& drive = city.drives[index];
  RunPlan run;
  run.name = drive.name;
  run.route = drive.name;
  run.says = drive.says;
  run.seed = city.seed * 1000 + index * 10 + 1;
  run.motion.seed = run.seed;
  run.motion.start_s = 1000.0 * static_cast<double>(index);
  run.motion.from_m = drive.skipped_m;
  const double end_m = city.network.routes[index].path.length_m() - drive.left_out_m;
  run.motion.to_m = std::min(end_m, run.motion.from_m + length_m);
  run.has_receiver = true;
  run.has_odometer = true;
  run.has_oncoming = index % 3 != 0;
  run.has_truck_ahead = index % 5 == 3;
  run.keeps_frames = true;
  return run;
}

RunPlan city_map_run(const City& city, std::size_t index, double length_m) {
  RunPlan run = run_of(city, index, length_m);
  run.motion.cruise_mps = 10 + static_cast<double>(index % 3);
  run.motion.wander_m = 0.1;
  run.spacing_m = 2;
  run.heading_jitter_deg = 0.1;
  run.pitch_jitter_deg = 0.1;
  run.light = light_of(index);
  return run;
}

// By another driver: frames by time, some of them late or lost.
RunPlan tour_run(const City& city, std::size_t index, double length_m) {
  RunPlan run = run_of(city, index, length_m);
  run.motion.cruise_mps = 9 + static_cast<double>(index % 3);
  run.motion.lateral_m = index % 2 == 0 ? 0.25 : -0.25;
  run.motion.wander_m = 0.2;
  be_driven_by_another(run);
  run.light = light_of(index + 1);
  run.light.sun_azimuth_deg -= 12;
  run.light.sun_elevation_deg -= 3;
  run.states_lanes = true;
  return run;
}

}  // namespace

std::vector<RunPlan> city_runs(const City& city, double length_m) {
  std::vector<RunPlan> runs;
  for (std::size_t i = 0; i < city.drives.size(); ++i) {
    runs.push_back(city.drives[i].is_tour ? tour_run(city, i, length_m)
                                          : city_map_run(city, i, length_m));
  }
  return runs;
}

}  // namespace milepost::simulator
