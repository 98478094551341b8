#include "tests/simulator/projection.h"

#include <algorithm>
#include <cmath>

#include "schema/geo/geodesy.h"

namespace milepost::simulator {
namespace {

constexpr double kNearM = 0.1;

}  // namespace

Projection Projection::pinhole(const Camera& camera, const Pose& pose) {
  const double heading = pose.heading_deg * kRadPerDeg;
  const double pitch = pose.pitch_deg * kRadPerDeg;
  const double roll = pose.roll_deg * kRadPerDeg;
  const Point level(std::sin(heading), std::cos(heading), 0);
  const Point right(std::cos(heading), -std::sin(heading), 0);
  const Point forward = level * std::cos(pitch) + Point(0, 0, std::sin(pitch));
  const Point down = forward.cross(right);
  Projection view;
  view.position_ = pose.position;
  view.right_ = right * std::cos(roll) + down * std::sin(roll);
  view.down_ = down * std::cos(roll) - right * std::sin(roll);
  view.forward_ = forward;
  view.focal_px_ = {camera.pinhole.focal_x_px, camera.pinhole.focal_y_px};
  view.principal_px_ = {camera.pinhole.principal_x_px, camera.pinhole.principal_y_px};
  view.size_ = {camera.width_px, camera.height_px};
  return view;
}

Projection Projection::parallel(const Point& origin, const Point& right, const Point& down,
                                const Point& forward, double m_per_px, const cv::Size& size) {
  Projection view;
  view.is_pinhole_ = false;
  view.position_ = origin;
  view.right_ = right;
  view.down_ = down;
  view.forward_ = forward;
  view.focal_px_ = {1 / m_per_px, 1 / m_per_px};
  view.principal_px_ = {0, 0};
  view.size_ = size;
  return view;
}

Point Projection::ray(double x_px, double y_px) const {
  if (!is_pinhole_) return forward_;
  return forward_ + right_ * ((x_px - principal_px_[0]) / focal_px_[0]) +
         down_ * ((y_px - principal_px_[1]) / focal_px_[1]);
}

Point Projection::point_at(const SeenSurface& seen, double x_px, double y_px) const {
  const double nearness = seen.nearness.at(x_px, y_px);
  if (is_pinhole_) return position_ + ray(x_px, y_px) * (1 / std::max(nearness, 1e-5));
  return position_ + right_ * (x_px / focal_px_[0]) + down_ * (y_px / focal_px_[1]) -
         forward_ * nearness;
}

Point Projection::seen_at(const Point& point) const {
  const Point offset = point - position_;
  return {offset.dot(right_) * focal_px_[0], offset.dot(down_) * focal_px_[1],
          -offset.dot(forward_)};
}

// The component along `axis` of a pinhole's ray, or of a parallel ray's origin, by pixel.
LinearInPixel Projection::ray_along(const Point& axis) const {
  const double across = right_.dot(axis) / focal_px_[0];
  const double down = down_.dot(axis) / focal_px_[1];
  const double ahead = is_pinhole_ ? forward_.dot(axis) : 0;
  return {ahead - principal_px_[0] * across - principal_px_[1] * down, across, down};
}

cv::Point2d Projection::project(const Point& from_position) const {
  const double depth = is_pinhole_ ? from_position.dot(forward_) : 1;
  return {principal_px_[0] + focal_px_[0] * from_position.dot(right_) / depth,
          principal_px_[1] + focal_px_[1] * from_position.dot(down_) / depth};
}

// Quick rejection of most surfaces outside of the picture, by the bounding sphere.
bool Projection::may_see(const Surface& surface) const {
  const Point offset = surface.centre - position_;
  const double across = offset.dot(right_);
  const double down = offset.dot(down_);
  const double reach = surface.radius_m;
  const cv::Vec2d last(size_.width - 1.0, size_.height - 1.0);
  if (!is_pinhole_) {
    return (across + reach) * focal_px_[0] > -1 && (across - reach) * focal_px_[0] < last[0] + 1 &&
           (down + reach) * focal_px_[1] > -1 && (down - reach) * focal_px_[1] < last[1] + 1;
  }
  const double depth = offset.dot(forward_);
  if (depth + reach < kNearM) return false;
  // Distance to the four planes through the pinhole and the picture's sides.
  const auto outside = [&](double part, double focal, double principal, double end) {
    const double low = (principal + 1) / focal;
    const double high = (end + 1 - principal) / focal;
    return part + low * depth < -reach * std::hypot(1.0, low) ||
           part - high * depth > reach * std::hypot(1.0, high);
  };
  return !outside(across, focal_px_[0], principal_px_[0], last[0]) &&
         !outside(down, focal_px_[1], principal_px_[1], last[1]);
}

std::optional<SeenSurface> Projection::see(const Surface& surface) const {
  if (!may_see(surface)) return std::nullopt;
  const auto& corners = surface.corners;
  const Point cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const Point normal = cross * (1 / cv::norm(cross));
  const double distance_m = normal.dot(corners[0] - position_);
  SeenSurface seen;
  seen.surface = &surface;
  const auto texel = [&](const Point& per_m) {
    const LinearInPixel along_ray = ray_along(per_m);
    const double start = per_m.dot(position_ - surface.map.origin);
    if (is_pinhole_) return seen.nearness * start + along_ray;
    return LinearInPixel{start, 0, 0} + along_ray + seen.nearness * -forward_.dot(per_m);
  };
  if (is_pinhole_) {
    if (std::abs(distance_m) < 1e-6) return std::nullopt;
    seen.nearness = ray_along(normal) * (1 / distance_m);
  } else {
    const double facing = normal.dot(forward_);
    if (std::abs(facing) < 1e-6) return std::nullopt;
    seen.nearness = LinearInPixel{-distance_m / facing, 0, 0} + ray_along(normal) * (1 / facing);
  }
  seen.u = texel(surface.map.u_per_m);
  seen.v = texel(surface.map.v_per_m);
  seen.texels_per_px = cv::norm(surface.map.u_per_m) / focal_px_[0];
  for (int i = 0; i < surface.corner_count; ++i) {
    const Point a = corners[i] - position_;
    const Point b = corners[(i + 1) % surface.corner_count] - position_;
    if (!is_pinhole_) {
      seen.outline[seen.corner_count++] = project(a);
      continue;
    }
    const double za = a.dot(forward_) - kNearM;
    const double zb = b.dot(forward_) - kNearM;
    if (za >= 0) seen.outline[seen.corner_count++] = project(a);
    if ((za >= 0) != (zb >= 0)) {
      seen.outline[seen.corner_count++] = project(a + (b - a) * (za / (za - zb)));
    }
  }
  if (seen.corner_count < 3) return std::nullopt;
  return seen;
}

}  // namespace milepost::simulator
