// A wall quantized as stored in a tile (FORMAT.md 6.4, 6.5).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "schema/tile/wall.h"

namespace milepost {

inline constexpr std::int64_t kStepsPerDegree = 100'000'000;
inline constexpr std::int64_t kStepsPerCell = kStepsPerDegree / kCellsPerDegree;
inline constexpr std::int64_t kMaxWallSteps = kStepsPerDegree / 10;

struct WallSteps {
  std::int32_t begin_north = 0;  // from the cell's south-west corner
  std::int32_t begin_east = 0;
  std::int32_t way_north = 0;  // from the begin to the end
  std::int32_t way_east = 0;
  std::uint16_t sigma_cm = 0;
};

// The cell's south-west corner, in steps from the equator and the prime meridian.
inline std::int64_t corner_north(std::uint32_t cell) {
  return std::int64_t{GridCell::numbered(cell).row} * kStepsPerCell - 90 * kStepsPerDegree;
}
inline std::int64_t corner_east(std::uint32_t cell) {
  return std::int64_t{GridCell::numbered(cell).column} * kStepsPerCell - 180 * kStepsPerDegree;
}

// REQUIRES: as tiles_of.
inline WallSteps steps_of(const Wall& wall, std::uint32_t cell) {
  const auto steps = [](double degrees) {
    return static_cast<std::int64_t>(std::llround(degrees * double{kStepsPerDegree}));
  };
  const std::int64_t begin_north = steps(wall.begin.latitude_deg);
  const std::int64_t begin_east = steps(wall.begin.longitude_deg);
  return {static_cast<std::int32_t>(begin_north - corner_north(cell)),
          static_cast<std::int32_t>(begin_east - corner_east(cell)),
          static_cast<std::int32_t>(steps(wall.end.latitude_deg) - begin_north),
          static_cast<std::int32_t>(steps(wall.end.longitude_deg) - begin_east),
          static_cast<std::uint16_t>(std::clamp(std::lround(wall.sigma_m * 100), 1L, 65535L))};
}

inline Wall wall_of(const WallSteps& steps, std::uint32_t cell) {
  const auto degrees = [](std::int64_t steps_from_zero) {
    return static_cast<double>(steps_from_zero) / double{kStepsPerDegree};
  };
  const std::int64_t begin_north = corner_north(cell) + steps.begin_north;
  const std::int64_t begin_east = corner_east(cell) + steps.begin_east;
  return {{degrees(begin_north), degrees(begin_east)},
          {degrees(begin_north + steps.way_north), degrees(begin_east + steps.way_east)},
          steps.sigma_cm / 100.0};
}

}  // namespace milepost
