#include "mapper/network/geocentric.h"

#include <GeographicLib/Geocentric.hpp>

namespace milepost {

Eigen::Vector3d geocentric(const GeoPoint& point) {
  Eigen::Vector3d position_m;
  GeographicLib::Geocentric::WGS84().Forward(point.latitude_deg, point.longitude_deg, 0,
                                             position_m.x(), position_m.y(), position_m.z());
  return position_m;
}

}  // namespace milepost
