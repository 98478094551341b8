#include "tests/simulator/paint.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace milepost::simulator {

namespace {

// The finalizer of SplitMix64.
std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

}  // namespace

float lattice_noise(std::int64_t x, std::int64_t y, std::uint64_t seed) {
  const std::uint64_t bits = mixed(seed + static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL +
                                   static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL);
  return static_cast<float>(bits >> 40) / static_cast<float>(1 << 24);
}

cv::RNG seeded(std::uint64_t seed) { return {mixed(seed + 0x9e3779b97f4a7c15ULL)}; }

float smooth_noise(double x, double y, std::uint64_t seed) {
  const double left = std::floor(x);
  const double top = std::floor(y);
  const auto ease = [](double part) { return static_cast<float>(part * part * (3 - 2 * part)); };
  const float fx = ease(x - left);
  const float fy = ease(y - top);
  const auto ix = static_cast<std::int64_t>(left);
  const auto iy = static_cast<std::int64_t>(top);
  const float upper = std::lerp(lattice_noise(ix, iy, seed), lattice_noise(ix + 1, iy, seed), fx);
  const float lower =
      std::lerp(lattice_noise(ix, iy + 1, seed), lattice_noise(ix + 1, iy + 1, seed), fx);
  return std::lerp(upper, lower, fy);
}

cv::Scalar shaded(const cv::Scalar& colour, double factor) { return colour * factor; }

cv::Scalar varied(const cv::Scalar& colour, double spread, cv::RNG& random) {
  const double common = random.uniform(-spread, spread);
  cv::Scalar near = colour;
  for (int i = 0; i < 3; ++i) {
    const double value = colour[i] + common + random.uniform(-spread, spread) / 4;
    near[i] = std::clamp(value, 0.0, 255.0);
  }
  return near;
}

void weather(cv::Mat& image, double grain, double stains, cv::RNG& random) {
  cv::Mat change(image.size(), CV_32F);
  random.fill(change, cv::RNG::NORMAL, 0, grain);
  for (const int cell_px : {12, 40, 130}) {
    cv::Mat coarse(image.rows / cell_px + 3, image.cols / cell_px + 3, CV_32F);
    random.fill(coarse, cv::RNG::NORMAL, 0, stains);
    cv::Mat stain;
    cv::resize(coarse, stain, image.size(), 0, 0, cv::INTER_CUBIC);
    change += stain;
  }
  cv::Mat changes;
  cv::merge(std::vector<cv::Mat>{change, change, change}, changes);
  cv::add(image, changes, image, cv::noArray(), CV_8UC3);
}

}  // namespace milepost::simulator
