#include "tests/simulator/runs.h"

#include <algorithm>

namespace milepost::simulator {
namespace {

constexpr const char* kQuickRoute = "street";

// The begin and end of a route's drives.
struct Leg {
  const char* route;
  double from_m, to_m;
  double cruise_mps;
};

constexpr Leg kLegs[] = {{"town-main", 40, 490, 11},
                         {"town-hill", 8, 318, 12},
                         {"town-loop", 4, 318, 8},
                         {kQuickRoute, 40, 160, 10}};

RunPlan plain_run(const Leg& leg, double length_m, std::uint64_t seed) {
  RunPlan run;
  run.route = leg.route;
  run.motion.from_m = leg.from_m;
  run.motion.to_m = std::min(leg.to_m, leg.from_m + length_m);
  run.motion.cruise_mps = leg.cruise_mps;
  run.motion.seed = seed;
  run.seed = seed;
  return run;
}

RunPlan map_run(const Leg& leg, double length_m, std::uint64_t seed) {
  RunPlan run = plain_run(leg, length_m, seed);
  run.name = run.route + "-map";
  run.says = "the mapping drive: a frame each 2 m, about noon";
  run.spacing_m = 2;
  run.heading_jitter_deg = 0.1;
  run.pitch_jitter_deg = 0.1;
  run.light = noon_light();
  run.has_receiver = true;
  run.has_odometer = true;
  return run;
}

// A later drive by another driver: frames by time, some of them late or lost.
RunPlan query_run(const Leg& leg, double length_m, std::uint64_t seed) {
  RunPlan run = plain_run(leg, length_m, seed);
  run.motion.from_m += std::min(3.0, length_m / 8);
  run.motion.start_s = 1000;
  run.frame_period_s = 0.2;
  be_driven_by_another(run);
  run.has_receiver = true;
  run.has_odometer = true;
  return run;
}

RunPlan easy_query(const Leg& leg, double length_m, std::uint64_t seed) {
  RunPlan run = query_run(leg, length_m, seed);
  run.name = run.route + "-query";
  run.says = "the same lane an hour earlier, another speed";
  run.motion.cruise_mps *= 0.85;
  run.motion.lateral_m = 0.2;
  run.motion.wander_m = 0.2;
  run.light = noon_light();
  run.light.sun_azimuth_deg -= 16;
  run.light.sun_elevation_deg -= 4;
  run.light.clouds_seed = 9;
  run.has_oncoming = true;
  return run;
}

RunPlan lane_query(const Leg& leg, double length_m, std::uint64_t seed) {
  RunPlan run = query_run(leg, length_m, seed);
  run.name = run.route + "-query-lane";
  run.says = "two hours later; over to the other lane and back";
  run.motion.cruise_mps *= 1.1;
  run.motion.lateral_m = -0.3;
  run.motion.wander_m = 0.15;
  const double way_m = run.motion.to_m - run.motion.from_m;
  const double over_m = std::min(40.0, way_m / 6);
  run.motion.lane_changes = {{run.motion.from_m + way_m * 0.22, over_m, -2 * kLaneM},
                             {run.motion.from_m + way_m * 0.68, over_m, 2 * kLaneM}};
  run.light = afternoon_light();
  return run;
}

RunPlan traffic_query(const Leg& leg, double length_m, std::uint64_t seed) {
  RunPlan run = query_run(leg, length_m, seed);
  run.name = run.route + "-query-traffic";
  run.says = "an overcast day behind a truck, with braking";
  run.motion.cruise_mps *= 0.8;
  run.motion.lateral_m = 0.1;
  run.motion.wander_m = 0.3;
  const double way_m = run.motion.to_m - run.motion.from_m;
  run.motion.slow_downs_m = {run.motion.from_m + way_m * 0.3, run.motion.from_m + way_m * 0.75};
  run.heading_jitter_deg = 0.7;
  run.pitch_jitter_deg = 0.5;
  run.light = overcast_light();
  run.has_truck_ahead = true;
  run.has_oncoming = true;
  run.image_noise = 4;
  return run;
}

// The same stretch of road in the opposite direction.
RunPlan back_query(const Leg& leg, double route_m, double length_m, std::uint64_t seed) {
  RunPlan run = query_run(leg, length_m, seed);
  run.name = run.route + "-query-back";
  run.says = "in the opposite direction";
  run.backwards = true;
  run.motion.from_m = route_m - std::min(leg.to_m, leg.from_m + length_m);
  run.motion.to_m = route_m - leg.from_m;
  run.motion.lateral_m = 0.1;
  run.motion.wander_m = 0.2;
  run.light = noon_light();
  return run;
}

}  // namespace

void be_driven_by_another(RunPlan& run) {
  run.period_jitter_s = 0.006;
  run.dropped_share = 0.02;
  run.image_noise = 3;
  run.heading_jitter_deg = 0.35;
  run.pitch_jitter_deg = 0.25;
  run.roll_jitter_deg = 0.15;
}

Path path_of(const Network& network, const RunPlan& run) {
  const Path& path = network.route(run.route)->path;
  return run.backwards ? path.reversed() : path;
}

std::vector<RunPlan> make_runs(const Network& network, std::uint64_t seed, double length_m) {
  std::vector<RunPlan> runs;
  for (const Leg& leg : kLegs) {
    if (network.route(leg.route) == nullptr) continue;
    std::vector<RunPlan> of_leg;
    const std::uint64_t first = seed * 1000 + runs.size() * 10;
    of_leg.push_back(map_run(leg, length_m, first + 1));
    of_leg.push_back(easy_query(leg, length_m, first + 2));
    const std::string route = leg.route;
    if (route == "town-main" || route == "town-hill") {
      of_leg.push_back(lane_query(leg, length_m, first + 3));
    }
    if (route == "town-main" || route == "town-loop") {
      of_leg.push_back(traffic_query(leg, length_m, first + 4));
    }
    for (RunPlan& run : of_leg) {
      if (route == "town-loop") run.has_oncoming = false;  // roundabouts have one direction
      runs.push_back(std::move(run));
    }
  }
  for (const Leg& leg : kLegs) {  // last, because seeds depend on the number of runs before
    const std::string route = leg.route;
    const Route* driven = network.route(route);
    if (driven == nullptr || route == "town-loop") continue;  // a roundabout has one direction
    runs.push_back(
        back_query(leg, driven->path.length_m(), length_m, seed * 1000 + runs.size() * 10));
  }
  return runs;
}

bool is_driven_by_default(const std::string& route) { return route != kQuickRoute; }

}  // namespace milepost::simulator
