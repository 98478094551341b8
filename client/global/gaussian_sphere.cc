#include "client/global/gaussian_sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "schema/geo/geodesy.h"

namespace milepost {

Eigen::Vector3d direction_of_pixel(const Pinhole& view, const Eigen::Vector2d& pixel) {
  return view.unproject(pixel.x(), pixel.y()).normalized();
}

double GreatCircle::arc_distance_rad(const Eigen::Vector3d& direction) const {
  return std::asin(std::min(1.0, std::abs(normal.dot(direction))));
}

double GreatCircle::sigma_rad(const Eigen::Vector3d& direction) const {
  return std::hypot(turn_sigma_rad * along.dot(direction), shift_sigma_rad * middle.dot(direction));
}

GreatCircle great_circle(const Pinhole& view, const LineSegment& segment, const LineNoise& noise) {
  const Eigen::Vector3d start = direction_of_pixel(view, segment.start_px);
  const Eigen::Vector3d end = direction_of_pixel(view, segment.end_px);
  GreatCircle circle;
  circle.normal = start.cross(end).normalized();
  circle.middle = (start + end).normalized();
  circle.along = circle.normal.cross(circle.middle);

  // For two ends with independent noise the mean moves by end / sqrt 2 and the slope by sqrt 2 end.
  const double length_rad = 2 * std::asin(std::min(1.0, (end - start).norm() / 2));
  const double end_rad = noise.end_px * length_rad / segment.length_px();
  circle.turn_sigma_rad =
      std::hypot(std::numbers::sqrt2 * end_rad / length_rad, noise.bend_deg * kRadPerDeg);
  circle.shift_sigma_rad = end_rad / std::numbers::sqrt2;
  return circle;
}

std::vector<GreatCircle> great_circles(const Pinhole& view, std::span<const LineSegment> segments,
                                       const LineNoise& noise) {
  std::vector<GreatCircle> circles;
  circles.reserve(segments.size());
  for (const LineSegment& segment : segments) {
    circles.push_back(great_circle(view, segment, noise));
  }
  return circles;
}

std::vector<Eigen::Vector3d> intersections(std::span<const GreatCircle> circles,
                                           double min_angle_rad) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < circles.size(); ++i) {
    for (std::size_t j = i + 1; j < circles.size(); ++j) {
      const Eigen::Vector3d point = circles[i].normal.cross(circles[j].normal);
      const double sine = point.norm();
      if (sine < std::sin(min_angle_rad)) continue;
      points.push_back(point.y() > 0 ? Eigen::Vector3d(-point / sine)
                                     : Eigen::Vector3d(point / sine));
    }
  }
  return points;
}

}  // namespace milepost
