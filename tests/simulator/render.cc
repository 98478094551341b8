#include "tests/simulator/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

constexpr double kNearM = 0.1;
constexpr int kSamplesPerSide = 2;  // of a pixel, for the edges
constexpr std::size_t kSamplesPerPixel = 4;
constexpr std::int32_t kSky = -1;

// The camera's axes in the scene.
struct View {
  Camera camera;
  Point position, right, down, forward;

  // The direction through a pixel; its part along `forward` is 1.
  Point ray(double x_px, double y_px) const {
    return forward + right * ((x_px - camera.principal_x_px) / camera.focal_x_px) +
           down * ((y_px - camera.principal_y_px) / camera.focal_y_px);
  }
};

View view_of(const Camera& camera, const Pose& pose) {
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  const double heading = pose.heading_deg * kRadPerDeg;
  const double pitch = pose.pitch_deg * kRadPerDeg;
  const double roll = pose.roll_deg * kRadPerDeg;
  const Point level(std::sin(heading), std::cos(heading), 0);
  const Point right(std::cos(heading), -std::sin(heading), 0);
  const Point forward = level * std::cos(pitch) + Point(0, 0, std::sin(pitch));
  const Point down = forward.cross(right);
  return {camera, pose.position, right * std::cos(roll) + down * std::sin(roll),
          down * std::cos(roll) - right * std::sin(roll), forward};
}

// A function of the pixel that is linear: value = constant + x * per_column + y * per_row.
struct LinearInPixel {
  double constant, per_column, per_row;

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

// The ray's part along `axis`, by pixel.
LinearInPixel ray_along(const View& view, const Point& axis) {
  return {view.ray(0, 0).dot(axis), view.right.dot(axis) / view.camera.focal_x_px,
          view.down.dot(axis) / view.camera.focal_y_px};
}

// A surface as the camera sees it. With depth z along the optical axis, 1/z, across/z and down/z
// are linear in the pixel, as for every plane behind a pinhole.
struct SeenSurface {
  const Surface* surface = nullptr;
  LinearInPixel inverse_depth, across_over_depth, down_over_depth;
  cv::Rect2d bounds_px;  // of its picture
};

// The corners in front of the camera, cut off at the near plane.
std::vector<Point> visible_outline(const View& view, const Surface& surface) {
  const Point across = surface.across * surface.width_m;
  const Point down = surface.down * surface.height_m;
  const Point first = surface.top_left - view.position;
  const std::array<Point, 4> corners = {first, first + across, first + across + down, first + down};
  std::vector<Point> outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point& a = corners[i];
    const Point& b = corners[(i + 1) % corners.size()];
    const double za = a.dot(view.forward) - kNearM;
    const double zb = b.dot(view.forward) - kNearM;
    if (za >= 0) outline.push_back(a);
    if ((za >= 0) != (zb >= 0)) outline.push_back(a + (b - a) * (za / (za - zb)));
  }
  return outline;
}

cv::Rect2d bounds_of(const View& view, const std::vector<Point>& outline) {
  const Camera& camera = view.camera;
  double left = camera.width_px, right = -1, top = camera.height_px, bottom = -1;
  for (const Point& point : outline) {
    const double z = point.dot(view.forward);
    const double x = camera.principal_x_px + camera.focal_x_px * point.dot(view.right) / z;
    const double y = camera.principal_y_px + camera.focal_y_px * point.dot(view.down) / z;
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  return {left, top, std::max(0.0, right - left), std::max(0.0, bottom - top)};
}

SeenSurface seen(const View& view, const Surface& surface) {
  const Point offset = view.position - surface.top_left;
  const Point normal = surface.across.cross(surface.down);
  const double distance_m = -normal.dot(offset);
  if (std::abs(distance_m) < 1e-6) return {};  // edge on
  SeenSurface result;
  result.inverse_depth = ray_along(view, normal) * (1 / distance_m);
  const auto over_depth = [&](const Point& axis) {
    return result.inverse_depth * axis.dot(offset) + ray_along(view, axis);
  };
  result.across_over_depth = over_depth(surface.across);
  result.down_over_depth = over_depth(surface.down);
  result.bounds_px = bounds_of(view, visible_outline(view, surface));
  if (result.bounds_px.width > 0 && result.bounds_px.height > 0) result.surface = &surface;
  return result;
}

// Which surface lies in front at each of the samples.
class Visibility {
 public:
  explicit Visibility(const Camera& camera)
      : columns_(camera.width_px * kSamplesPerSide),
        rows_(camera.height_px * kSamplesPerSide),
        front_(index_of(rows_, 0), kSky),
        inverse_depth_(front_.size(), 0) {}

  void add(const SeenSurface& seen, std::int32_t index) {
    const cv::Rect2d& box = seen.bounds_px;
    const int first_row = std::clamp(sample(box.y) - 1, 0, rows_);
    const int end_row = std::clamp(sample(box.y + box.height) + 2, 0, rows_);
    const int first_column = std::clamp(sample(box.x) - 1, 0, columns_);
    const int end_column = std::clamp(sample(box.x + box.width) + 2, 0, columns_);
    for (int row = first_row; row < end_row; ++row) {
      for (int column = first_column; column < end_column; ++column) {
        add_sample(seen, index, row, column);
      }
    }
  }

  std::array<std::int32_t, kSamplesPerPixel> in_front(int x_px, int y_px) const {
    const std::size_t at = index_of(y_px * kSamplesPerSide, x_px * kSamplesPerSide);
    return {front_[at], front_[at + 1], front_[at + columns_], front_[at + columns_ + 1]};
  }

 private:
  // Pixels are counted at their centres, samples are spread evenly over each.
  static double pixel(int sample) { return (sample + 0.5) / kSamplesPerSide - 0.5; }
  static int sample(double pixel) {
    return static_cast<int>(std::clamp((pixel + 0.5) * kSamplesPerSide, -1e6, 1e6));
  }

  std::size_t index_of(int row, int column) const {
    return static_cast<std::size_t>(row) * columns_ + column;
  }

  void add_sample(const SeenSurface& seen, std::int32_t index, int row, int column) {
    const double x = pixel(column);
    const double y = pixel(row);
    const double inverse_depth = seen.inverse_depth.at(x, y);
    const std::size_t at = index_of(row, column);
    if (inverse_depth <= inverse_depth_[at] || inverse_depth > 1 / kNearM) return;
    const double across = seen.across_over_depth.at(x, y);
    const double down = seen.down_over_depth.at(x, y);
    if (across < 0 || across > seen.surface->width_m * inverse_depth) return;
    if (down < 0 || down > seen.surface->height_m * inverse_depth) return;
    inverse_depth_[at] = inverse_depth;
    front_[at] = index;
  }

  int columns_;
  int rows_;
  std::vector<std::int32_t> front_;
  std::vector<double> inverse_depth_;
};

// A bright horizon below a blue sky with soft clouds, all at infinity.
cv::Vec3f sky_colour(const View& view, int x_px, int y_px) {
  const Point ray = cv::normalize(view.ray(x_px, y_px));
  const auto height = static_cast<float>(std::clamp(ray[2], 0.0, 1.0));
  const double azimuth = std::atan2(ray[0], ray[1]);
  const float clouds = smooth_noise(azimuth * 5, ray[2] * 9, 7) * 0.7F +
                       smooth_noise(azimuth * 13, ray[2] * 25, 8) * 0.3F;
  const cv::Vec3f clear =
      cv::Vec3f(238, 228, 215) * (1 - height) + cv::Vec3f(225, 170, 110) * height;
  return clear + (cv::Vec3f(250, 248, 246) - clear) * clouds;
}

cv::Vec3f surface_colour(const SeenSurface& seen, double x_px, double y_px) {
  const Surface& surface = *seen.surface;
  const double inverse_depth = std::max(seen.inverse_depth.at(x_px, y_px), 1e-5);
  const double across_m = seen.across_over_depth.at(x_px, y_px) / inverse_depth;
  const double down_m = seen.down_over_depth.at(x_px, y_px) / inverse_depth;
  // The quotient rule: how far the place on the surface moves from pixel to pixel.
  const auto moves = [&](const LinearInPixel& over_depth, double place_m, double texels_per_m) {
    const double scale = texels_per_m / inverse_depth;
    const LinearInPixel& depth = seen.inverse_depth;
    return cv::Vec2d((over_depth.per_column - place_m * depth.per_column) * scale,
                     (over_depth.per_row - place_m * depth.per_row) * scale);
  };
  const cv::Vec2f texels = surface.texels_per_m;
  const cv::Vec2f across = moves(seen.across_over_depth, across_m, texels[0]);
  const cv::Vec2f down = moves(seen.down_over_depth, down_m, texels[1]);
  const cv::Vec2f place(static_cast<float>(across_m * texels[0]),
                        static_cast<float>(down_m * texels[1]));
  return surface.texture->sample(place, {{across[0], down[0]}, {across[1], down[1]}}) *
         surface.light;
}

}  // namespace

cv::Mat render(const Scene& scene, const Camera& camera, const Pose& pose) {
  const View view = view_of(camera, pose);
  std::vector<SeenSurface> surfaces;
  Visibility visibility(camera);
  for (const Surface& surface : scene.surfaces) {
    const SeenSurface candidate = seen(view, surface);
    if (candidate.surface == nullptr) continue;
    visibility.add(candidate, static_cast<std::int32_t>(surfaces.size()));
    surfaces.push_back(candidate);
  }
  cv::Mat picture(camera.height_px, camera.width_px, CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      auto front = visibility.in_front(x, y);
      std::sort(front.begin(), front.end());
      cv::Vec3f sum(0, 0, 0);
      cv::Vec3f colour;
      for (std::size_t i = 0; i < front.size(); ++i) {
        if (i == 0 || front[i] != front[i - 1]) {
          colour =
              front[i] == kSky ? sky_colour(view, x, y) : surface_colour(surfaces[front[i]], x, y);
        }
        sum += colour;
      }
      picture.at<cv::Vec3b>(y, x) = sum / static_cast<float>(front.size());
    }
  }
  return picture;
}

}  // namespace milepost::simulator
