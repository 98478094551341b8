#include "server/catalog/degree_box.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace milepost::server {
namespace {

// A degree of latitude is never shorter on WGS84 than here; nor is a degree of longitude, times
// the cosine of the latitude.
constexpr double kMetresPerDegree = 110500;

// How far `longitude_deg` lies outside [west, east], going round the shorter way.
double degrees_outside(double longitude_deg, double west_deg, double east_deg) {
  if (west_deg <= longitude_deg && longitude_deg <= east_deg) return 0;
  return std::min(wrapped_360(west_deg - longitude_deg), wrapped_360(longitude_deg - east_deg));
}

}  // namespace

DegreeBox DegreeBox::around(const std::vector<GeoPoint>& points) {
  const GeoPoint& first = points.front();
  DegreeBox box{first.longitude_deg, first.latitude_deg, first.longitude_deg, first.latitude_deg};
  for (const GeoPoint& point : points) {
    box = joined(
        box, {point.longitude_deg, point.latitude_deg, point.longitude_deg, point.latitude_deg});
  }
  return box;
}

DegreeBox DegreeBox::joined(const DegreeBox& a, const DegreeBox& b) {
  return {std::min(a.west_deg, b.west_deg), std::min(a.south_deg, b.south_deg),
          std::max(a.east_deg, b.east_deg), std::max(a.north_deg, b.north_deg)};
}

bool DegreeBox::may_be_within(const GeoPoint& position, double radius_m) const {
  const double reach_deg = radius_m / kMetresPerDegree;
  const double latitude_deg = position.latitude_deg;
  if (latitude_deg < south_deg - reach_deg || latitude_deg > north_deg + reach_deg) return false;
  // Degrees of longitude are shortest at the end of the reach that is nearer to a pole.
  const double highest_deg = std::abs(latitude_deg) + reach_deg;
  if (highest_deg >= 90) return true;
  const double shrink = std::cos(highest_deg * std::numbers::pi / 180);
  return degrees_outside(position.longitude_deg, west_deg, east_deg) <= reach_deg / shrink;
}

}  // namespace milepost::server
