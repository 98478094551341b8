#include "schema/geo/geodesy.h"

#include <cmath>

#include <GeographicLib/Geodesic.hpp>

namespace milepost {

bool is_valid(const GeoPoint& point) {
  return std::abs(point.latitude_deg) <= 90 && std::abs(point.longitude_deg) <= 180 &&
         std::isfinite(point.altitude_m);
}

double geodesic_distance_m(const GeoPoint& from, const GeoPoint& to) {
  double distance_m = 0;
  GeographicLib::Geodesic::WGS84().Inverse(from.latitude_deg, from.longitude_deg, to.latitude_deg,
                                           to.longitude_deg, distance_m);
  return distance_m;
}

double geodesic_azimuth_deg(const GeoPoint& from, const GeoPoint& to) {
  double azimuth_deg = 0;
  double azimuth_at_end_deg = 0;
  GeographicLib::Geodesic::WGS84().Inverse(from.latitude_deg, from.longitude_deg, to.latitude_deg,
                                           to.longitude_deg, azimuth_deg, azimuth_at_end_deg);
  return wrapped_360(azimuth_deg);
}

double wrapped_360(double angle_deg) {
  const double wrapped = std::fmod(angle_deg, 360.0);
  const double turned = wrapped < 0 ? wrapped + 360.0 : wrapped;
  return turned >= 360.0 ? 0.0 : turned;  // a tiny negative angle rounds up to 360
}

double turn_deg(double from_deg, double to_deg) {
  return 180 - wrapped_360(180 - (to_deg - from_deg));
}

LocalFrame::LocalFrame(const GeoPoint& origin)
    : frame_(origin.latitude_deg, origin.longitude_deg, origin.altitude_m) {}

EnuPoint LocalFrame::enu_from_geo(const GeoPoint& point) const {
  EnuPoint enu;
  frame_.Forward(point.latitude_deg, point.longitude_deg, point.altitude_m, enu.east_m, enu.north_m,
                 enu.up_m);
  return enu;
}

GeoPoint LocalFrame::geo_from_enu(const EnuPoint& point) const {
  GeoPoint geo;
  frame_.Reverse(point.east_m, point.north_m, point.up_m, geo.latitude_deg, geo.longitude_deg,
                 geo.altitude_m);
  return geo;
}

}  // namespace milepost
