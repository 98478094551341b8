#include "mapper/aerial/sun_evidence.h"

#include <algorithm>
#include <cmath>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kMinAreaM2 = 6;       // of a region that may be a roof
constexpr double kMaxAreaM2 = 2500;    // the same
constexpr double kMinWidthM = 1.5;     // the same
constexpr double kMinFilled = 0.7;     // share of its rectangle, the same
constexpr double kMinDarker = 0.2;     // share of a region's lightness that is missing in a shadow
constexpr double kMaxDarker = 0.7;     // and beyond which no more is counted
constexpr double kMinAgreement = 0.1;  // share of shaded outline that points one way

bool may_be_roof(const Region& region) {
  return region.area_m2 >= kMinAreaM2 && region.area_m2 <= kMaxAreaM2 &&
         region.width_m >= kMinWidthM &&
         region.area_m2 >= kMinFilled * region.length_m * region.width_m;
}

// The mean lightness outside of a point of an outline, 0.6 to 1.4 m away.
double lightness_outside(const RegionMap& map, const OutlinePoint& point) {
  double sum = 0;
  for (const double distance_m : {0.6, 1.0, 1.4}) {
    const Eigen::Vector2d at = point.at_px + distance_m / map.grid.metres_per_pixel * point.outward;
    const int x = std::clamp(static_cast<int>(std::lround(at.x())), 0, map.lab.cols - 1);
    const int y = std::clamp(static_cast<int>(std::lround(at.y())), 0, map.lab.rows - 1);
    sum += map.lab.at<cv::Vec3f>(y, x)[0];
  }
  return sum / 3;
}

}  // namespace

void SunEvidence::add(const RegionMap& map) {
  for (const Region& region : map.regions) {
    if (!may_be_roof(region)) continue;
    Eigen::Vector2d sides = Eigen::Vector2d::Zero();
    for (const OutlinePoint& point : region.outline) {
      const double own = std::max(region.mean_lab[0], 1.0);
      const double darker = std::min((own - lightness_outside(map, point)) / own, kMaxDarker);
      if (darker < kMinDarker) continue;
      const double shaded_m = (darker - kMinDarker) * map.grid.metres_per_pixel;
      sides += shaded_m * Eigen::Vector2d(point.outward.x(), -point.outward.y());
    }
    shaded_sides_ += sides;
    shaded_m_ += sides.norm();
  }
}

std::optional<double> SunEvidence::azimuth_deg() const {
  if (shaded_m_ <= 0 || shaded_sides_.norm() < kMinAgreement * shaded_m_) return std::nullopt;
  return wrapped_360(std::atan2(-shaded_sides_.x(), -shaded_sides_.y()) / kRadPerDeg);
}

}  // namespace milepost
