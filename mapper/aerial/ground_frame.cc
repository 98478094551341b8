#include "mapper/aerial/ground_frame.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <GeographicLib/Constants.hpp>

namespace milepost {
namespace {

double on_earth(double longitude_deg) {
  return std::abs(longitude_deg) <= 180 ? longitude_deg : std::remainder(longitude_deg, 360.0);
}

}  // namespace

GroundFrame::GroundFrame(const GeoPoint& origin)
    : projection_(GeographicLib::Constants::WGS84_a(), GeographicLib::Constants::WGS84_f(), 1.0),
      origin_{origin.latitude_deg, origin.longitude_deg, 0} {
  double east_m = 0;
  projection_.Forward(origin.longitude_deg, origin.latitude_deg, origin.longitude_deg, east_m,
                      origin_northing_m_);
}

Eigen::Vector2d GroundFrame::ground_from_geo(const GeoPoint& point) const {
  double east_m = 0;
  double northing_m = 0;
  projection_.Forward(origin_.longitude_deg, point.latitude_deg, point.longitude_deg, east_m,
                      northing_m);
  return {east_m, northing_m - origin_northing_m_};
}

GeoPoint GroundFrame::geo_from_ground(const Eigen::Vector2d& ground_m) const {
  GeoPoint point;
  projection_.Reverse(origin_.longitude_deg, ground_m.x(), ground_m.y() + origin_northing_m_,
                      point.latitude_deg, point.longitude_deg);
  return point;
}

Bounds GroundFrame::bounds_of(const Eigen::Vector2d& south_west_m,
                              const Eigen::Vector2d& north_east_m) const {
  const double west_m = south_west_m.x();
  const double east_m = north_east_m.x();
  // On the origin's meridian the latitudes of a border are extreme.
  const double middle_m = std::clamp(0.0, west_m, east_m);
  Bounds box{360, 90, -360, -90};  // longitudes relative to the origin's
  for (const double x_m : {west_m, middle_m, east_m}) {
    for (const double y_m : {south_west_m.y(), north_east_m.y()}) {
      const GeoPoint point = geo_from_ground({x_m, y_m});
      const double east_deg = std::remainder(point.longitude_deg - origin_.longitude_deg, 360.0);
      box = box.joined({east_deg, point.latitude_deg, east_deg, point.latitude_deg});
    }
  }
  for (const double pole_deg : {-90.0, 90.0}) {
    const Eigen::Vector2d pole_m = ground_from_geo({pole_deg, origin_.longitude_deg, 0});
    if ((pole_m.array() >= south_west_m.array()).all() &&
        (pole_m.array() <= north_east_m.array()).all()) {
      return Bounds{-180, box.south_deg, 180, box.north_deg}.joined({0, pole_deg, 0, pole_deg});
    }
  }
  return {on_earth(origin_.longitude_deg + box.west_deg), box.south_deg,
          on_earth(origin_.longitude_deg + box.east_deg), box.north_deg};
}

std::string GroundFrame::proj() const {
  std::ostringstream text;
  text << std::setprecision(12) << "+proj=tmerc +lat_0=" << origin_.latitude_deg
       << " +lon_0=" << origin_.longitude_deg
       << " +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m +no_defs";
  return text.str();
}

}  // namespace milepost
