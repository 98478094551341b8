#include "schema/geo/near.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

// A lower bound of a degree of latitude on WGS84 and, times the cosine of the latitude, of a degree
// of longitude.
constexpr double kMetresPerDegree = 110500;

// How far `longitude_deg` lies outside [west, east], the shorter way round.
double degrees_outside(double longitude_deg, double west_deg, double east_deg) {
  if (west_deg <= longitude_deg && longitude_deg <= east_deg) return 0;
  return std::min(wrapped_360(west_deg - longitude_deg), wrapped_360(longitude_deg - east_deg));
}

}  // namespace

bool is_near_radius(double radius_m) { return radius_m > 0 && radius_m <= kMaxNearRadiusM; }

Bounds bounds_around(const std::vector<GeoPoint>& points) {
  const auto at = [](const GeoPoint& point) {
    return Bounds{point.longitude_deg, point.latitude_deg, point.longitude_deg, point.latitude_deg};
  };
  Bounds box = at(points.front());
  for (const GeoPoint& point : points) box = box.joined(at(point));
  return box;
}

Bounds bounds_within(const GeoPoint& position, double radius_m) {
  const double reach_deg = radius_m / kMetresPerDegree;
  const double south_deg = std::max(position.latitude_deg - reach_deg, -90.0);
  const double north_deg = std::min(position.latitude_deg + reach_deg, 90.0);
  const double highest_deg = std::abs(position.latitude_deg) + reach_deg;
  const double shrink = highest_deg >= 90 ? 0 : std::cos(highest_deg * kRadPerDeg);
  if (reach_deg >= 180 * shrink) return {-180, south_deg, 180, north_deg};
  const auto wrapped = [](double degrees) { return std::remainder(degrees, 360); };
  const double across_deg = reach_deg / shrink;
  return {wrapped(position.longitude_deg - across_deg), south_deg,
          wrapped(position.longitude_deg + across_deg), north_deg};
}

bool may_be_within(const Bounds& box, const GeoPoint& position, double radius_m) {
  const double reach_deg = radius_m / kMetresPerDegree;
  const double latitude_deg = position.latitude_deg;
  if (latitude_deg < box.south_deg - reach_deg || latitude_deg > box.north_deg + reach_deg) {
    return false;
  }
  // Degrees of longitude are shortest at the latitude within reach that is nearest to a pole.
  const double highest_deg = std::abs(latitude_deg) + reach_deg;
  if (highest_deg >= 90) return true;
  const double shrink = std::cos(highest_deg * kRadPerDeg);
  return degrees_outside(position.longitude_deg, box.west_deg, box.east_deg) <= reach_deg / shrink;
}

std::optional<LineProjection> BoxedLine::nearest_within(const GeoPoint& position,
                                                        double radius_m) const {
  if (!may_be_within(box, position, radius_m)) return std::nullopt;
  const LineProjection nearest = line.project(position);
  if (nearest.distance_m > radius_m) return std::nullopt;
  return nearest;
}

}  // namespace milepost
