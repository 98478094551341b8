#include "tests/simulator/centreline.h"

#include <cmath>
#include <numbers>

namespace milepost::simulator {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kStraightPerM = 1e-9;

cv::Vec2d forward_of(double heading_deg) {
  return {std::sin(heading_deg * kRadPerDeg), std::cos(heading_deg * kRadPerDeg)};
}

cv::Vec2d right_of(double heading_deg) {
  return {std::cos(heading_deg * kRadPerDeg), -std::sin(heading_deg * kRadPerDeg)};
}

}  // namespace

Centreline::Centreline(double heading_deg, double curvature_per_m)
    : heading_deg_(heading_deg),
      curvature_per_m_(curvature_per_m),
      start_forward_(forward_of(heading_deg)),
      start_right_(right_of(heading_deg)) {}

double Centreline::heading_deg_at(double along_m) const {
  return heading_deg_ + along_m * curvature_per_m_ / kRadPerDeg;
}

cv::Vec2d Centreline::position_at(const StreetPlace& place) const {
  if (std::abs(curvature_per_m_) < kStraightPerM) {
    return start_forward_ * place.along_m + start_right_ * place.lateral_m;
  }
  const double radius_m = 1 / curvature_per_m_;
  const cv::Vec2d centre = start_right_ * radius_m;
  return centre - right_of(heading_deg_at(place.along_m)) * (radius_m - place.lateral_m);
}

StreetPlace Centreline::place_of(const cv::Vec2d& position) const {
  if (std::abs(curvature_per_m_) < kStraightPerM) {
    return {position.dot(start_forward_), position.dot(start_right_)};
  }
  const double radius_m = 1 / curvature_per_m_;
  const double side = radius_m > 0 ? 1 : -1;
  const cv::Vec2d to_centre = (start_right_ * radius_m - position) * side;
  const double heading_rad = std::atan2(-to_centre[1], to_centre[0]);
  const double turned_rad =
      std::remainder(heading_rad - heading_deg_ * kRadPerDeg, 2 * std::numbers::pi);
  return {turned_rad * radius_m, radius_m - side * cv::norm(to_centre)};
}

}  // namespace milepost::simulator
