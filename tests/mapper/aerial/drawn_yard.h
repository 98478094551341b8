// Aerial pictures of houses, drawn for tests: roofs on bare ground, their shadows, a hedge.
#pragma once

#include <filesystem>
#include <vector>

#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/sun.h"
#include "mapper/aerial/wall_line.h"

namespace milepost::testing {

// A house of length along an axis, turned counterclockwise from east, of metres.
struct House {
  Eigen::Vector2d middle_m;
  double length_m = 12;
  double width_m = 8;
  double turn_deg = 0;
};

// The four walls, the house on the right of each.
WallLines walls_of(const House& house);

// A yard whose south-west corner is 0, 0. Grey values have a little noise, the same each time.
struct Yard {
  Eigen::Vector2d size_m;
  std::vector<House> houses;
  Sun sun;
  double shadow_m = 3;                 // 0: none
  std::vector<Eigen::Vector2d> trees;  // of 6 m, rough and green
};

Picture drawn(const Yard& yard, double metres_per_pixel = 0.1);

// The yard's south-west corner is at latitude 0.35, longitude 32.59. A GeoTIFF in a grid of metres.
void write_geotiff(const Picture& picture, const std::filesystem::path& file);
GeoPoint geo_from_yard(const Eigen::Vector2d& yard_m);

// Whether each sampled point of the wall, 0.25 m apart, is within `reach_m` of a line of the same
// direction.
bool is_found(const WallLine& wall, const WallLines& lines, double reach_m);

}  // namespace milepost::testing
