#include "tests/simulator/ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

const cv::Vec3f kMarking(215, 222, 222);
const cv::Vec3f kKerb(165, 168, 168);
constexpr double kKerbM = 0.18;
constexpr double kCrossingM = 3.5;  // length of the zebra crossing along the street
constexpr double kGrainsPerM = 40;
constexpr double kManholeRadiusM = 0.33;

bool is_inside(double value, double from, double to) { return value >= from && value < to; }

// The place inside a period, [0, period).
double phase(double value, double period) { return value - std::floor(value / period) * period; }

}  // namespace

Ground::Ground(Centreline line, double from_m, double to_m, std::uint64_t seed)
    : line_(std::move(line)), seed_(seed) {
  cv::RNG random(seed);
  crossing_m_ = from_m + (to_m - from_m) * random.uniform(0.3, 0.5);
  for (double along = from_m; along < to_m; along += random.uniform(2.0, 7.0)) {
    repairs_.push_back({along, random.uniform(-3.3, 2.2), random.uniform(0.6, 5.0),
                        random.uniform(0.4, 1.6), random.uniform(-22.0F, 16.0F)});
  }
  for (double along = from_m; along < to_m; along += random.uniform(9.0, 22.0)) {
    manholes_.push_back({along, random.uniform(-2.8, 2.8)});
  }
}

cv::Mat Ground::paint(const cv::Vec2d& north_west, double side_m, int texels_per_m) const {
  const int side = static_cast<int>(std::lround(side_m * texels_per_m));
  cv::Mat image(side, side, CV_8UC3);
  for (int row = 0; row < side; ++row) {
    const double north_m = north_west[1] - (row + 0.5) / texels_per_m;
    for (int column = 0; column < side; ++column) {
      const double east_m = north_west[0] + (column + 0.5) / texels_per_m;
      image.at<cv::Vec3b>(row, column) = colour_at({east_m, north_m});
    }
  }
  cv::GaussianBlur(image, image, {}, 0.7);  // softens grains and the steps of slanted edges
  return image;
}

cv::Vec3f Ground::colour_at(const cv::Vec2d& position) const {
  const double east = position[0];
  const double north = position[1];
  const float fine =
      lattice_noise(static_cast<std::int64_t>(std::floor(east * kGrainsPerM)),
                    static_cast<std::int64_t>(std::floor(north * kGrainsPerM)), seed_ + 1) -
      0.5F;
  const float coarse = smooth_noise(east * 5, north * 5, seed_ + 2) - 0.5F;
  const float wide = smooth_noise(east * 0.7, north * 0.7, seed_ + 3) - 0.5F;
  const float grain = 48 * fine + 18 * coarse + 22 * wide;
  const StreetPlace place = line_.place_of(position);
  const bool is_road = std::abs(place.lateral_m) < kRoadHalfWidthM;
  return is_road ? road_colour(place, grain) : pavement_colour(place, grain);
}

cv::Vec3f Ground::road_colour(const StreetPlace& place, float grain) const {
  for (const Manhole& manhole : manholes_) {
    const double distance =
        std::hypot(place.along_m - manhole.along_m, place.lateral_m - manhole.lateral_m);
    if (distance < kManholeRadiusM) {
      const bool is_rib = phase(place.along_m, 0.12) < 0.05 || phase(place.lateral_m, 0.12) < 0.05;
      return cv::Vec3f::all((is_rib ? 95.0F : 55.0F) + grain / 3);
    }
  }
  if (is_marking(place)) return kMarking + cv::Vec3f::all(grain * 0.6F);
  float shade = 96 + grain;
  for (const Repair& repair : repairs_) {
    const double along = place.along_m - repair.along_m;
    const double lateral = place.lateral_m - repair.lateral_m;
    if (!is_inside(along, 0, repair.length_m) || !is_inside(lateral, 0, repair.width_m)) continue;
    const double edge =
        std::min({along, lateral, repair.length_m - along, repair.width_m - lateral});
    shade += edge < 0.05 ? -38 : repair.shade;
  }
  return {shade, shade, shade * 0.98F};
}

bool Ground::is_marking(const StreetPlace& place) const {
  if (is_inside(place.along_m, crossing_m_, crossing_m_ + kCrossingM)) {
    return phase(place.lateral_m, 1.0) < 0.5;
  }
  const double lateral = std::abs(place.lateral_m);
  if (is_inside(lateral, 3.05, 3.17)) return true;
  return lateral < 0.075 && phase(place.along_m, 9) < 3;
}

cv::Vec3f Ground::pavement_colour(const StreetPlace& place, float grain) const {
  const double beyond_m = std::abs(place.lateral_m) - kRoadHalfWidthM;
  if (beyond_m < kKerbM) {
    const bool is_joint = phase(place.along_m, 1.0) < 0.03 || beyond_m < 0.03;
    return is_joint ? cv::Vec3f::all(70) : kKerb + cv::Vec3f::all(grain * 0.7F);
  }
  constexpr double kSlabM = 0.5;
  const bool is_joint = phase(place.along_m, kSlabM) < 0.025 || phase(beyond_m, kSlabM) < 0.025;
  if (is_joint) return cv::Vec3f::all(85);
  const auto slab_x = static_cast<std::int64_t>(std::floor(place.along_m / kSlabM));
  const auto slab_y = static_cast<std::int64_t>(std::floor(place.lateral_m / kSlabM));
  const float slab = 40 * (lattice_noise(slab_x, slab_y, seed_ + 4) - 0.5F);
  const float shade = 142 + slab + grain * 0.7F;
  return {shade * 0.96F, shade, shade};
}

}  // namespace milepost::simulator
