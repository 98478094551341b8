// Positions on the WGS84 ellipsoid and in local tangent frames (FRAMES.md).
#pragma once

#include <numbers>

#include <GeographicLib/LocalCartesian.hpp>

namespace milepost {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;
inline constexpr double kDegPerRad = 180 / std::numbers::pi;

struct GeoPoint {
  double latitude_deg = 0;   // [-90, 90], WGS84
  double longitude_deg = 0;  // [-180, 180], WGS84
  double altitude_m = 0;     // above the ellipsoid

  friend bool operator==(const GeoPoint&, const GeoPoint&) = default;
};

// Metres east, north and up of a local tangent frame's origin.
struct EnuPoint {
  double east_m = 0;
  double north_m = 0;
  double up_m = 0;
};

// Whether latitude and longitude are finite and in range.
bool is_valid(const GeoPoint& point);

// Length of the geodesic on the ellipsoid's surface between two points; altitudes are ignored.
double geodesic_distance_m(const GeoPoint& from, const GeoPoint& to);

// Azimuth of the geodesic at `from`, clockwise from north, [0, 360).
double geodesic_azimuth_deg(const GeoPoint& from, const GeoPoint& to);

// Wraps an angle into [0, 360).
double wrapped_360(double angle_deg);

// The smallest signed turn from one direction to another, clockwise, (-180, 180].
double turn_deg(double from_deg, double to_deg);

// The tangent frame at an origin. Immutable, so safe to share between threads.
class LocalFrame {
 public:
  explicit LocalFrame(const GeoPoint& origin);
  EnuPoint enu_from_geo(const GeoPoint& point) const;
  GeoPoint geo_from_enu(const EnuPoint& point) const;

 private:
  GeographicLib::LocalCartesian frame_;
};

}  // namespace milepost
