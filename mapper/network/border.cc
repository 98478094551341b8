#include "mapper/network/border.h"

#include <string>

#include <Eigen/Geometry>

#include "mapper/network/geocentric.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

std::string text_of(const GeoPoint& point) {
  return shortest_fixed(point.latitude_deg) + "," + shortest_fixed(point.longitude_deg);
}

}  // namespace

Result<Border> Border::through(const GeoPoint& from, const GeoPoint& to) {
  const std::string name = "border " + text_of(from) + "," + text_of(to);
  if (!is_valid(from) || !is_valid(to)) {
    return Error{ErrorCode::invalid_input, name, "a point of it is no position on Earth",
                 "give latitudes from -90 to 90 and longitudes from -180 to 180 degrees"};
  }
  constexpr double kLeastM = 1;
  if (geodesic_distance_m(from, to) < kLeastM) {
    return Error{ErrorCode::invalid_input, name, "its points are one place",
                 "give two points that are far apart"};
  }
  return Border(geocentric(from).cross(geocentric(to)).normalized());
}

}  // namespace milepost
