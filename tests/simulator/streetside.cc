#include "tests/simulator/streetside.h"

#include "tests/simulator/furniture.h"
#include "tests/simulator/paint.h"
#include "tests/simulator/vehicle.h"

namespace milepost::simulator {
namespace {

// One object on the pavement or verge, if there is room.
void add_something(Scene& scene, const Site& site, const Road& road, double along_m, int side,
                   cv::RNG& random) {
  const int kind = random.uniform(0, 10);
  const bool is_open = road.frontage_at(along_m) == Frontage::open;
  if (is_open) {
    const auto at = site.beside(road, along_m, side, 1.1);
    if (at && kind < 5) add_bollard(scene, *at, random);
    if (at && kind == 5) add_traffic_sign(scene, *at, random);
    return;
  }
  const double wide_m = pavement_width_m(road.frontage_at(along_m));
  const auto kerb = site.beside(road, along_m, side, 0.45);
  const auto wall = site.beside(road, along_m, side, wide_m - 0.45);
  if (!kerb || !wall) return;
  if (kind < 3) {
    add_traffic_sign(scene, *kerb, random);
  } else if (kind < 5) {
    add_bollard(scene, *kerb, random);
  } else if (kind < 7) {
    add_bin(scene, *wall, random);
  } else if (kind == 7) {
    add_cabinet(scene, *wall, random);
  } else if (kind == 8 && wide_m > 2.5) {
    add_column(scene, *kerb, random);
  }
}

}  // namespace

void park_vehicles(Scene& scene, const Site& site, std::uint64_t seed) {
  cv::RNG random = seeded(seed);
  for (const Road& road : site.network().roads) {
    if (road.parking_m == 0) continue;
    for (const int side : {-1, 1}) {
      for (double along = 4; along + 4 < road.path.length_m(); along += 6) {
        const int kind = random.uniform(0, 12);
        const std::uint64_t look = random.next();
        const double shift_m = random.uniform(-0.35, 0.35);
        if (kind >= 8 || site.is_near_junction(road, along)) continue;
        const cv::Vec2d at = road.path.position_at(
            {along + shift_m, side * (road.half_width_m - road.parking_m / 2 - 0.02)});
        const double heading = road.path.heading_rad_at(along) + random.uniform(-0.03, 0.03);
        const Vehicle vehicle(kind < 4   ? VehicleKind::hatchback
                              : kind < 7 ? VehicleKind::saloon
                                         : VehicleKind::van,
                              look);
        vehicle.add_to(scene.surfaces, site.on_ground(at), forward_of(heading) * side);
      }
    }
  }
}

void furnish_streets(Scene& scene, const Site& site, std::uint64_t seed) {
  cv::RNG random = seeded(seed);
  for (const Road& road : site.network().roads) {
    int side = 1;
    for (double along = 8; along < road.path.length_m(); along += random.uniform(11.0, 15.0)) {
      side = -side;
      if (road.frontage_at(along) == Frontage::open) continue;
      if (const auto at = site.beside(road, along, side, 0.5)) add_lamp(scene, *at, random);
    }
    for (const int each : {-1, 1}) {
      for (double along = 3; along < road.path.length_m(); along += random.uniform(4.0, 13.0)) {
        add_something(scene, site, road, along, each, random);
      }
    }
  }
}

}  // namespace milepost::simulator
