#include "schema/feature/wisurf.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

constexpr int kSamples = 20;  // along each side
constexpr int kCellSamples = 5;
constexpr int kCells = kSamples / kCellSamples;

// The bounds of a wavelet along one side of the image, in pixels: first half, then second half.
struct Halves {
  int from, middle, to;
};

Halves halves_at(int sample, int length_px) {
  const double step_px = static_cast<double>(length_px) / kSamples;
  const double centre_px = (sample + 0.5) * step_px;
  const auto pixel = [&](double px) {
    return std::clamp(static_cast<int>(std::lround(px)), 0, length_px);
  };
  return {pixel(centre_px - step_px), pixel(centre_px), pixel(centre_px + step_px)};
}

// Mean grey value of [x0, x1) x [y0, y1), 0 of nothing. `sums` is the integral image.
double mean_of(const cv::Mat& sums, int x0, int x1, int y0, int y1) {
  const int area = (x1 - x0) * (y1 - y0);
  if (area == 0) return 0;
  const int sum =
      sums.at<int>(y1, x1) - sums.at<int>(y0, x1) - sums.at<int>(y1, x0) + sums.at<int>(y0, x0);
  return static_cast<double>(sum) / area;
}

}  // namespace

ImageDescriptor wisurf(const cv::Mat& gray) {
  cv::Mat sums;
  cv::integral(gray, sums, CV_32S);
  std::array<double, kImageDescriptorValues> values{};
  for (int j = 0; j < kSamples; ++j) {
    const Halves y = halves_at(j, gray.rows);
    for (int i = 0; i < kSamples; ++i) {
      const Halves x = halves_at(i, gray.cols);
      const double dx = mean_of(sums, x.middle, x.to, y.from, y.to) -
                        mean_of(sums, x.from, x.middle, y.from, y.to);
      const double dy = mean_of(sums, x.from, x.to, y.middle, y.to) -
                        mean_of(sums, x.from, x.to, y.from, y.middle);
      const int first = 4 * (j / kCellSamples * kCells + i / kCellSamples);
      double* cell = &values[first];
      cell[0] += dx;
      cell[1] += dy;
      cell[2] += std::abs(dx);
      cell[3] += std::abs(dy);
    }
  }
  double square = 0;
  for (const double value : values) square += value * value;
  ImageDescriptor descriptor{};
  if (square == 0) return descriptor;
  std::ranges::transform(values, descriptor.begin(), [&](double value) {
    return static_cast<float>(value / std::sqrt(square));
  });
  return descriptor;
}

}  // namespace milepost
