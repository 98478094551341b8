#include "mapper/aerial/ground_frame.h"

#include <iomanip>
#include <sstream>

#include <GeographicLib/Constants.hpp>

namespace milepost {

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

std::string GroundFrame::proj() const {
  std::ostringstream text;
  text << std::setprecision(12) << "+proj=tmerc +lat_0=" << origin_.latitude_deg
       << " +lon_0=" << origin_.longitude_deg
       << " +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m +no_defs";
  return text.str();
}

}  // namespace milepost
