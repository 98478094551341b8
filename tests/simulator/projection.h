// Pinhole and parallel projections of planar surfaces, for cameras, the sun and aerial pictures.
#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "schema/drive/drive.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

// The pose of a camera.
struct Pose {
  Point position;
  double heading_deg = 0;  // clockwise from north
  double pitch_deg = 0;    // upwards
  double roll_deg = 0;     // clockwise, as seen from behind the camera
};

// A function of the pixel that is linear: value = constant + x * per_column + y * per_row.
struct LinearInPixel {
  double constant = 0, per_column = 0, per_row = 0;

  double at(double x_px, double y_px) const {
    return constant + x_px * per_column + y_px * per_row;
  }
  friend LinearInPixel operator*(const LinearInPixel& f, double k) {
    return {f.constant * k, f.per_column * k, f.per_row * k};
  }
  friend LinearInPixel operator+(const LinearInPixel& f, const LinearInPixel& g) {
    return {f.constant + g.constant, f.per_column + g.per_column, f.per_row + g.per_row};
  }
};

// A projected surface. For a pinhole, 1/depth, u/depth and v/depth are linear in the pixel; for a
// parallel projection depth, u and v are. `nearness` is 1/depth or -depth: greater is nearer.
struct SeenSurface {
  const Surface* surface = nullptr;
  LinearInPixel nearness, u, v;  // for a pinhole, u and v divided by depth
  double texels_per_px = 0;      // for a pinhole, divided by depth; for a frontal view
  std::array<cv::Point2d, 8> outline;
  int corner_count = 0;
};

// Pixel coordinates refer to pixel centres: that of the top left one is (0, 0).
class Projection {
 public:
  static Projection pinhole(const Camera& camera, const Pose& pose);
  // Parallel to `forward`: pixel (x, y) looks from origin + right * x * m_per_px + down * y *
  // m_per_px.
  static Projection parallel(const Point& origin, const Point& right, const Point& down,
                             const Point& forward, double m_per_px, const cv::Size& size);

  cv::Size size() const { return size_; }
  bool is_pinhole() const { return is_pinhole_; }
  const Point& position() const { return position_; }

  // The direction through a pixel; a pinhole's has 1 along the optical axis.
  Point ray(double x_px, double y_px) const;
  // The point of a surface that a pixel shows.
  Point point_at(const SeenSurface& seen, double x_px, double y_px) const;
  // The projection of a point: pixel x, pixel y, nearness. In a parallel projection only.
  Point seen_at(const Point& point) const;
  // Nothing if the surface is edge-on or out of the picture.
  std::optional<SeenSurface> see(const Surface& surface) const;

 private:
  bool may_see(const Surface& surface) const;
  cv::Point2d project(const Point& from_position) const;
  LinearInPixel ray_along(const Point& axis) const;

  bool is_pinhole_ = true;
  Point position_;  // of the pinhole, or of pixel (0, 0)
  Point right_, down_, forward_;
  cv::Vec2d focal_px_;  // pixels per metre, in a parallel projection
  cv::Vec2d principal_px_;
  cv::Size size_;
};

}  // namespace milepost::simulator
