#include "tests/simulator/traffic.h"

#include <cmath>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

constexpr double kGapM = 15;  // from the camera to the truck's middle, on average
constexpr double kGapSwingM = 3.5;

}  // namespace

Traffic::Traffic(const Network& network, const RunPlan& run)
    : network_(network),
      route_(*network.route(run.route)),
      path_(path_of(network, run)),
      start_s_(run.motion.start_s),
      seed_(run.seed) {
  cv::RNG random = seeded(run.seed * 31 + 5);
  if (run.has_truck_ahead) trucks_.emplace_back(VehicleKind::truck, random.next());
  if (!run.has_oncoming) return;
  double along = run.motion.from_m + random.uniform(30.0, 60.0);
  while (along < run.motion.to_m + 900) {
    const int kind = random.uniform(0, 8);
    const VehicleKind body = kind < 4   ? VehicleKind::saloon
                             : kind < 6 ? VehicleKind::hatchback
                             : kind < 7 ? VehicleKind::van
                                        : VehicleKind::truck;
    oncoming_.push_back({Vehicle(body, random.next()), along, 9.5});
    along += random.uniform(70.0, 160.0);
  }
}

void Traffic::place(Moving& moving, const Vehicle& vehicle, double along_m, double lateral_m,
                    double towards) const {
  const cv::Vec2d at = path_.position_at({along_m, lateral_m});
  const Point centre(at[0], at[1], route_.height_m(network_.terrain, along_m, at));
  const cv::Vec2d forward = forward_of(path_.heading_rad_at(along_m)) * towards;
  vehicle.add_to(moving.surfaces, centre, forward);
  moving.shades.push_back(vehicle.shade(centre, forward));
}

Moving Traffic::at(double time_s, double along_m) const {
  constexpr double kSightM = 250;
  Moving moving;
  for (const Vehicle& truck : trucks_) {
    const double gap = kGapM + kGapSwingM * std::sin(along_m / 31 + static_cast<double>(seed_));
    place(moving, truck, along_m + gap, route_.lane_m, 1);
  }
  for (const Oncoming& car : oncoming_) {
    const double at_m = car.along_m - car.speed_mps * (time_s - start_s_);
    if (std::abs(at_m - along_m) > kSightM || at_m < 0 || at_m > path_.length_m()) continue;
    if (!route_.span_at(at_m).has_oncoming) continue;
    place(moving, car.vehicle, at_m, route_.lane_m - 2 * kLaneM, -1);
  }
  return moving;
}

}  // namespace milepost::simulator
