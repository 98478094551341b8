#include "tests/simulator/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

constexpr int kColumns = 2048;
constexpr int kRows = 512;  // from the zenith to the horizon
constexpr double kPi = std::numbers::pi;

// Clouds are in a layer overhead, so that they become smaller towards the horizon.
float cloud_density(const Point& direction, const Light& light) {
  const double height = direction[2] + 0.12;
  const double x = direction[0] / height * 1.6;
  const double y = direction[1] / height * 1.6;
  float sum = 0;
  float weight = 0.5F;
  double scale = 1;
  for (int octave = 0; octave < 5; ++octave) {
    sum += weight * smooth_noise(x * scale, y * scale, light.clouds_seed * 16 + octave);
    weight *= 0.5F;
    scale *= 2.1;
  }
  const float threshold = 0.72F - 0.5F * light.cloud_cover;
  return std::clamp((sum - threshold) * 4.5F, 0.0F, 1.0F);
}

cv::Vec3f sky_colour(const Point& direction, const Light& light) {
  const auto up = static_cast<float>(std::max(direction[2], 0.0));
  const float to_horizon = std::pow(1 - up, 3.0F);
  const cv::Vec3f clear =
      cv::Vec3f(205, 152, 98) * (1 - to_horizon) + cv::Vec3f(236, 222, 206) * to_horizon;
  const auto near_sun = static_cast<float>(std::max(direction.dot(light.to_sun()), 0.0));
  const float glow = light.cloud_cover < 1 ? 60 * std::pow(near_sun, 24.0F) : 0;
  const float density = cloud_density(direction, light);
  const float cover = light.cloud_cover >= 1 ? 1 : density;
  const float shade = light.cloud_cover >= 1 ? 205 + 40 * density : 252 - 42 * density * (1 - up);
  const cv::Vec3f cloud(shade, shade * 0.985F, shade * 0.97F);
  return clear + (cloud - clear) * (cover * 0.92F) + cv::Vec3f::all(glow);
}

}  // namespace

Sky::Sky(const Light& light)
    : panorama_(kRows, kColumns, CV_8UC3), haze_(sky_colour({0, 0, 0}, light) * 0.93F) {
  for (int row = 0; row < kRows; ++row) {
    const double elevation = kPi / 2 * (1 - (row + 0.5) / kRows);
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2 * kPi * (column + 0.5) / kColumns;
      const Point direction(std::sin(azimuth) * std::cos(elevation),
                            std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
      panorama_.at<cv::Vec3b>(row, column) = sky_colour(direction, light);
    }
  }
}

cv::Vec3f Sky::colour(const Point& direction) const {
  const double level = std::hypot(direction[0], direction[1]);
  const double elevation = std::atan2(direction[2], level);
  double azimuth = std::atan2(direction[0], direction[1]);
  if (azimuth < 0) azimuth += 2 * kPi;
  const double x = azimuth / (2 * kPi) * kColumns - 0.5;
  const double y = std::clamp((1 - elevation / (kPi / 2)) * kRows - 0.5, 0.0, kRows - 1.001);
  const double left = std::floor(x);
  const int x0 = (static_cast<int>(left) + kColumns) % kColumns;
  const int x1 = (x0 + 1) % kColumns;
  const int y0 = static_cast<int>(y);
  const auto fx = static_cast<float>(x - left);
  const auto fy = static_cast<float>(y - y0);
  const auto texel = [this](int row, int column) -> cv::Vec3f {
    return panorama_.at<cv::Vec3b>(row, column);
  };
  const cv::Vec3f upper = texel(y0, x0) * (1 - fx) + texel(y0, x1) * fx;
  const cv::Vec3f lower = texel(y0 + 1, x0) * (1 - fx) + texel(y0 + 1, x1) * fx;
  return upper * (1 - fy) + lower * fy;
}

}  // namespace milepost::simulator
