#include "tests/simulator/render.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/simulator/raster.h"

namespace milepost::simulator {
namespace {

constexpr int kSamplesPerSide = 2;  // of a pixel, for the edges
constexpr std::size_t kSamplesPerPixel = 4;

bool is_shaded(const Shade& shade, const Point& point, const Point& to_sun) {
  const Point offset = point - shade.centre;
  const auto along = [&](const Point& v) {
    return v[0] * shade.forward[0] + v[1] * shade.forward[1];
  };
  const auto across = [&](const Point& v) {
    return v[0] * shade.forward[1] - v[1] * shade.forward[0];
  };
  double enter = 0.15;
  double leave = 40;
  const auto clip = [&](double at, double step, double low, double high) {
    const double safe = std::abs(step) < 1e-9 ? 1e-9 : step;
    const double a = (low - at) / safe;
    const double b = (high - at) / safe;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  };
  clip(along(offset), along(to_sun), -shade.half_length_m, shade.half_length_m);
  clip(across(offset), across(to_sun), -shade.half_width_m, shade.half_width_m);
  clip(offset[2], to_sun[2], 0.25, shade.height_m);
  return enter < leave;
}

// Bright colours are compressed below white, as by a camera's tone curve.
float exposed(float value) {
  constexpr float kKnee = 190;
  constexpr float kRange = 255 - kKnee;
  return value < kKnee ? value : kKnee + kRange * (1 - std::exp((kKnee - value) / kRange));
}

class Shader {
 public:
  Shader(const Lighting& lighting, const Projection& projection, const Moving& moving)
      : lighting_(lighting),
        projection_(projection),
        moving_(moving),
        to_sun_(lighting.light.to_sun()) {}

  cv::Vec3f sky(double x_px, double y_px) const {
    return lighting_.sky ? lighting_.sky->colour(projection_.ray(x_px, y_px))
                         : cv::Vec3f(235, 215, 195);
  }

  cv::Vec3f surface(const SeenSurface& seen, double x_px, double y_px) const {
    const cv::Vec4f texel = textured(seen, x_px, y_px);
    const cv::Vec3f colour(texel[0], texel[1], texel[2]);
    if (!lighting_.sky) return colour;
    const Point point = projection_.point_at(seen, x_px, y_px);
    const cv::Vec3f light = light_at(*seen.surface, point);
    // Colours are stored with a gamma of two, so light is applied by its square root.
    cv::Vec3f result;
    for (int i = 0; i < 3; ++i) result[i] = exposed(colour[i] * std::sqrt(light[i]));
    if (!projection_.is_pinhole()) return result;
    const auto distance = static_cast<float>(cv::norm(point - projection_.position()));
    const float clear = std::exp(-lighting_.light.haze_per_m * distance);
    return result * clear + lighting_.sky->haze() * (1 - clear);
  }

 private:
  cv::Vec4f textured(const SeenSurface& seen, double x_px, double y_px) const {
    double depth = 1;
    double moved_u = 0, moved_v = 0;  // of a pinhole's quotient rule
    if (projection_.is_pinhole()) {
      depth = 1 / std::max(seen.nearness.at(x_px, y_px), 1e-5);
      moved_u = seen.u.at(x_px, y_px) * depth;
      moved_v = seen.v.at(x_px, y_px) * depth;
    }
    const auto moves = [&](const LinearInPixel& place, double moved) {
      return cv::Vec2d((place.per_column - moved * seen.nearness.per_column) * depth,
                       (place.per_row - moved * seen.nearness.per_row) * depth);
    };
    const cv::Vec2f u = moves(seen.u, moved_u);
    const cv::Vec2f v = moves(seen.v, moved_v);
    const cv::Vec2f place(static_cast<float>(seen.u.at(x_px, y_px) * depth),
                          static_cast<float>(seen.v.at(x_px, y_px) * depth));
    return seen.surface->texture->sample(place, {{u[0], v[0]}, {u[1], v[1]}});
  }

  cv::Vec3f light_at(const Surface& surface, const Point& point) const {
    Point normal = surface.normal;
    const Point to_eye =
        projection_.is_pinhole() ? projection_.position() - point : -projection_.ray(0, 0);
    const bool is_leaf = surface.translucency > 0;
    if (!is_leaf && normal.dot(to_eye) < 0) normal = -normal;
    const double facing = normal.dot(to_sun_);
    const double direct =
        is_leaf ? surface.translucency + (1 - surface.translucency) * std::max(facing, 0.0)
                : std::max(facing, 0.0);
    auto sun = static_cast<float>(direct);
    if (sun > 0 && !surface.is_distant) sun *= lighting_.shadows->sunlight(point, normal);
    for (const Shade& shade : moving_.shades) {
      if (sun > 0 && is_shaded(shade, point, to_sun_)) sun = 0;
    }
    const Point outside = point + normal;
    const cv::Vec2d place(outside[0], outside[1]);
    const float open =
        lighting_.sky_view->open_share(place, outside[2] - lighting_.ground_m(place));
    const auto upwards = static_cast<float>(0.62 + 0.38 * normal[2]);
    return lighting_.light.sun * sun + lighting_.light.sky * (open * upwards * surface.openness) +
           lighting_.light.bounce * ((0.5F + open) * surface.openness);
  }

  const Lighting& lighting_;
  const Projection& projection_;
  const Moving& moving_;
  Point to_sun_;
};

}  // namespace

Lighting even_lighting() { return {}; }

cv::Mat render(const Scene& scene, const Lighting& lighting, const Projection& projection,
               const Moving& moving) {
  std::vector<SeenSurface> seen;
  Raster raster(projection.size(), kSamplesPerSide);
  for (const auto* surfaces : {&scene.surfaces, &moving.surfaces}) {
    for (const Surface& surface : *surfaces) {
      const auto candidate = projection.see(surface);
      if (!candidate) continue;
      raster.add(*candidate, projection.is_pinhole(), static_cast<std::int32_t>(seen.size()));
      seen.push_back(*candidate);
    }
  }
  const Shader shader(lighting, projection, moving);
  cv::Mat picture(projection.size(), CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const int column = x * kSamplesPerSide;
      const int row = y * kSamplesPerSide;
      std::array<std::int32_t, kSamplesPerPixel> front = {
          raster.front(column, row), raster.front(column + 1, row), raster.front(column, row + 1),
          raster.front(column + 1, row + 1)};
      std::sort(front.begin(), front.end());
      cv::Vec3f sum(0, 0, 0);
      cv::Vec3f colour;
      for (std::size_t i = 0; i < front.size(); ++i) {
        if (i == 0 || front[i] != front[i - 1]) {
          colour = front[i] == Raster::kNothing ? shader.sky(x, y)
                                                : shader.surface(seen[front[i]], x, y);
        }
        sum += colour;
      }
      picture.at<cv::Vec3b>(y, x) = sum / static_cast<float>(front.size());
    }
  }
  return picture;
}

cv::Mat render(const Scene& scene, const Lighting& lighting, const Camera& camera, const Pose& pose,
               const Moving& moving) {
  return render(scene, lighting, Projection::pinhole(camera, pose), moving);
}

}  // namespace milepost::simulator
