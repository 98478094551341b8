#include "tests/simulator/shadow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/simulator/raster.h"

namespace milepost::simulator {
namespace {

constexpr double kTexelM = 0.11;
constexpr double kNormalBiasM = 0.13;
constexpr double kDepthBiasM = 0.06;

// The smallest rectangle normal to the sun's rays that contains all shadow casters.
Projection projection_of(const Scene& scene, const Point& to_sun) {
  const Point forward = -to_sun;
  const Point right = cv::normalize(forward.cross(Point(0, 0, 1)));
  const Point down = forward.cross(right);
  double left = 0, end_right = 0, top = 0, bottom = 0;
  bool is_first = true;
  for (const Surface& surface : scene.surfaces) {
    if (surface.is_distant) continue;
    for (int i = 0; i < surface.corner_count; ++i) {
      const double x = surface.corners[i].dot(right);
      const double y = surface.corners[i].dot(down);
      left = is_first ? x : std::min(left, x);
      end_right = is_first ? x : std::max(end_right, x);
      top = is_first ? y : std::min(top, y);
      bottom = is_first ? y : std::max(bottom, y);
      is_first = false;
    }
  }
  const cv::Size size(static_cast<int>((end_right - left) / kTexelM) + 3,
                      static_cast<int>((bottom - top) / kTexelM) + 3);
  return Projection::parallel(right * (left - kTexelM) + down * (top - kTexelM), right, down,
                              forward, kTexelM, size);
}

}  // namespace

ShadowMap::ShadowMap(const Scene& scene, const Point& to_sun)
    : from_sun_(projection_of(scene, to_sun)) {
  Raster raster(from_sun_.size(), 1);
  for (const Surface& surface : scene.surfaces) {
    if (surface.is_distant) continue;
    if (const auto seen = from_sun_.see(surface)) raster.add(*seen, false, 0);
  }
  nearness_ = raster.take_nearness();
}

float ShadowMap::sunlight(const Point& point, const Point& normal) const {
  const Point seen = from_sun_.seen_at(point + normal * kNormalBiasM);
  const double x = seen[0] - std::floor(seen[0]);
  const double y = seen[1] - std::floor(seen[1]);
  const int column = static_cast<int>(std::floor(seen[0]));
  const int row = static_cast<int>(std::floor(seen[1]));
  const cv::Size size = from_sun_.size();
  if (column < 0 || row < 0 || column + 1 >= size.width || row + 1 >= size.height) return 1;
  const auto nearness = static_cast<float>(seen[2] + kDepthBiasM);
  const float* const upper = &nearness_[static_cast<std::size_t>(row) * size.width + column];
  const float* const lower = upper + size.width;
  const auto lit = [nearness](float front) { return front <= nearness ? 1.0 : 0.0; };
  return static_cast<float>((lit(upper[0]) * (1 - x) + lit(upper[1]) * x) * (1 - y) +
                            (lit(lower[0]) * (1 - x) + lit(lower[1]) * x) * y);
}

SkyView::SkyView(const cv::Mat& height_m, const cv::Vec2d& south_west)
    : share_(height_m.size(), CV_32F), south_west_(south_west) {
  constexpr int kDirections = 12;
  constexpr int kReachCells = 36;
  constexpr int kStepCells = 2;
  for (int row = 0; row < share_.rows; ++row) {
    for (int column = 0; column < share_.cols; ++column) {
      float sum = 0;
      for (int i = 0; i < kDirections; ++i) {
        const double azimuth = 2 * std::numbers::pi * i / kDirections;
        const double step_x = std::sin(azimuth);
        const double step_y = std::cos(azimuth);
        float steepest = 0;
        for (int reach = 1; reach < kReachCells; reach += kStepCells) {
          const int x = column + static_cast<int>(std::lround(step_x * reach));
          const int y = row + static_cast<int>(std::lround(step_y * reach));
          if (x < 0 || y < 0 || x >= share_.cols || y >= share_.rows) break;
          steepest = std::max(steepest, height_m.at<float>(y, x) / static_cast<float>(reach));
        }
        sum += 1 / (1 + steepest * steepest);  // the squared cosine of the horizon's elevation
      }
      share_.at<float>(row, column) = sum / kDirections;
    }
  }
}

float SkyView::open_share(const cv::Vec2d& position, double above_ground_m) const {
  constexpr double kRoofsM = 14;
  const cv::Vec2d cell = (position - south_west_) / kCellM - cv::Vec2d(0.5, 0.5);
  const int column = static_cast<int>(std::floor(cell[0]));
  const int row = static_cast<int>(std::floor(cell[1]));
  if (column < 0 || row < 0 || column + 1 >= share_.cols || row + 1 >= share_.rows) return 1;
  const auto fx = static_cast<float>(cell[0] - column);
  const auto fy = static_cast<float>(cell[1] - row);
  const float* const south = share_.ptr<float>(row) + column;
  const float* const north = share_.ptr<float>(row + 1) + column;
  const float ground =
      (south[0] * (1 - fx) + south[1] * fx) * (1 - fy) + (north[0] * (1 - fx) + north[1] * fx) * fy;
  const auto raised = static_cast<float>(std::clamp(above_ground_m / kRoofsM, 0.0, 1.0));
  return ground + (1 - ground) * raised;
}

}  // namespace milepost::simulator
