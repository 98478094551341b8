#include "mapper/aerial/footprint_ring.h"

#include <algorithm>
#include <cmath>

#include "schema/geo/geodesy.h"
#include "schema/tile/wall_steps.h"

namespace milepost {
namespace {

constexpr double kMaxWallDeg = 0.1;  // of a great circle: 11 km

bool is_same_place(const WallEnd& a, const WallEnd& b) {
  const double apart_deg = std::abs(a.longitude_deg - b.longitude_deg);
  return a.latitude_deg == b.latitude_deg &&
         (apart_deg == 0 || apart_deg == 360 || apart_deg == 720);
}

// The longitude, modulo 360, that is nearest to another one.
double longitude_near(double longitude_deg, double other_deg) {
  const double apart_deg = longitude_deg - other_deg;
  if (std::abs(apart_deg) <= 180) return longitude_deg;
  return longitude_deg - 360 * std::round(apart_deg / 360);
}

double longitude_on_earth(double longitude_deg) {
  return std::abs(longitude_deg) <= 180 ? longitude_deg : longitude_near(longitude_deg, 0);
}

// Unwraps longitudes that jump at 180.
void unroll(std::vector<WallEnd>& ring) {
  for (std::size_t i = 1; i < ring.size(); ++i) {
    ring[i].longitude_deg = longitude_near(ring[i].longitude_deg, ring[i - 1].longitude_deg);
  }
}

// In a tile's quantization steps, so that the ends of two halves are equal despite rounding.
std::int64_t steps_of(double latitude_deg) {
  return static_cast<std::int64_t>(std::llround(latitude_deg * double{kStepsPerDegree}));
}

double twice_area(const std::vector<WallEnd>& ring) {
  double twice_area = 0;
  const WallEnd& origin = ring.front();
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const double x1 = ring[i].longitude_deg - origin.longitude_deg;
    const double y1 = ring[i].latitude_deg - origin.latitude_deg;
    const double x2 = ring[i + 1].longitude_deg - origin.longitude_deg;
    const double y2 = ring[i + 1].latitude_deg - origin.latitude_deg;
    twice_area += x1 * y2 - x2 * y1;
  }
  return twice_area;
}

// REQUIRES: the ring is unrolled.
bool is_clockwise(const std::vector<WallEnd>& ring) {
  const double eastward_deg = ring.back().longitude_deg - ring.front().longitude_deg;
  if (std::abs(eastward_deg) < 180) return twice_area(ring) < 0;
  // Around a pole: eastward is counterclockwise, seen from above the northern one.
  return (eastward_deg < 0) == (ring.front().latitude_deg > 0);
}

bool is_too_long(const WallEnd& begin, const WallEnd& end) {
  const double north_deg = std::abs(begin.latitude_deg - end.latitude_deg);
  const double east_deg = std::abs(begin.longitude_deg - end.longitude_deg);
  const double nearest_pole_deg =
      std::max(std::abs(begin.latitude_deg), std::abs(end.latitude_deg));
  return north_deg > kMaxWallDeg ||
         east_deg * std::cos(nearest_pole_deg * kRadPerDeg) > kMaxWallDeg;
}

}  // namespace

std::optional<std::string> RingWalls::add(std::vector<WallEnd> ring, RingKind kind) {
  if (!is_same_place(ring.front(), ring.back())) {
    return "the ring's last position differs from its first";
  }
  unroll(ring);
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    if (is_too_long(ring[i], ring[i + 1])) return "a wall is longer than 0.1 degrees (11 km)";
  }
  if (is_clockwise(ring) != (kind == RingKind::outer)) std::reverse(ring.begin(), ring.end());
  for (WallEnd& end : ring) end.longitude_deg = longitude_on_earth(end.longitude_deg);
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    if (ring[i] != ring[i + 1]) add_wall({ring[i], ring[i + 1]});
  }
  return std::nullopt;
}

void RingWalls::add_wall(const Wall& wall) {
  if (std::abs(wall.begin.longitude_deg) != 180 || std::abs(wall.end.longitude_deg) != 180) {
    walls_.push_back(wall);
    return;
  }
  const bool is_northward = wall.begin.latitude_deg < wall.end.latitude_deg;
  const std::int64_t begin = steps_of(wall.begin.latitude_deg);
  const std::int64_t end = steps_of(wall.end.latitude_deg);
  CutWalls& between = on_180_[std::minmax(begin, end)];
  (is_northward ? between.northward : between.southward).push_back(wall);
}

std::vector<Wall> RingWalls::finish() && {
  for (const auto& [latitudes, cut] : on_180_) {
    const std::size_t pairs = std::min(cut.northward.size(), cut.southward.size());
    for (const std::vector<Wall>* const walls : {&cut.northward, &cut.southward}) {
      walls_.insert(walls_.end(), walls->begin() + static_cast<std::ptrdiff_t>(pairs),
                    walls->end());
    }
  }
  return std::move(walls_);
}

}  // namespace milepost
