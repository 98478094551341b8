#include "mapper/aerial/sun_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/aerial/sun.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kMinAreaM2 = 6;     // of a candidate roof region
constexpr double kMaxAreaM2 = 2500;  // the same
constexpr double kMinWidthM = 1.5;   // the same
constexpr double kMinFilled = 0.7;   // share of its rectangle, the same
constexpr double kMinDarker = 0.2;   // least relative loss of lightness in a shadow
constexpr double kMaxDarker = 0.7;   // at which the loss saturates
constexpr double kDegPerDirection = 2;
constexpr double kBorderFromM = 0.5;    // from a corner, where sampling of a shadow's border begins
constexpr double kBorderToM = 4;        // and where it ends
constexpr int kBorderSteps = 14;        // from the one to the other
constexpr double kBesideBorderM = 0.5;  // from the border to its lit and dark samples
constexpr int kSmoothing = 3;           // directions to either side that are averaged
constexpr int kSearched = 22;           // directions to either side of the coarse estimate
constexpr double kMinAgreement = 0.1;   // share of shaded outline that agrees in direction

bool may_be_roof(const Region& region) {
  return region.area_m2 >= kMinAreaM2 && region.area_m2 <= kMaxAreaM2 &&
         region.width_m >= kMinWidthM &&
         region.area_m2 >= kMinFilled * region.length_m * region.width_m;
}

double lightness_at(const RegionMap& map, const Eigen::Vector2d& at_px) {
  const int x = std::clamp(static_cast<int>(std::lround(at_px.x())), 0, map.lab.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(at_px.y())), 0, map.lab.rows - 1);
  return map.lab.at<cv::Vec3f>(y, x)[0];
}

// The mean lightness outside of an outline point, 0.6 to 1.4 m away.
double lightness_outside(const RegionMap& map, const OutlinePoint& point) {
  double sum = 0;
  for (const double distance_m : {0.6, 1.0, 1.4}) {
    sum += lightness_at(map, point.at_px + distance_m / map.grid.metres_per_pixel * point.outward);
  }
  return sum / 3;
}

// The sum of the normals of a region's outline where it is dark outside, weighted by darkness and
// length: east, north.
Eigen::Vector2d shaded_sides_of(const Region& region, const RegionMap& map) {
  Eigen::Vector2d sides = Eigen::Vector2d::Zero();
  for (const OutlinePoint& point : region.outline) {
    const double own = std::max(region.mean_lab[0], 1.0);
    const double darker = std::min((own - lightness_outside(map, point)) / own, kMaxDarker);
    if (darker < kMinDarker) continue;
    const double shaded_m = (darker - kMinDarker) * map.grid.metres_per_pixel;
    sides += shaded_m * Eigen::Vector2d(point.outward.x(), -point.outward.y());
  }
  return sides;
}

// The relative contrast, -1 to 1, between the lit and the shadow side of the line that runs from
// `corner_px` along the light. `beyond` is a unit vector across that line, away from the shadow.
double border_contrast(const RegionMap& map, const Eigen::Vector2d& corner_px,
                       const Eigen::Vector2d& light, const Eigen::Vector2d& beyond) {
  const Eigen::Vector2d aside = kBesideBorderM / map.grid.metres_per_pixel * beyond;
  double lit = 0;
  double dark = 0;
  for (int i = 0; i <= kBorderSteps; ++i) {
    const double along_m = kBorderFromM + (kBorderToM - kBorderFromM) * i / kBorderSteps;
    const Eigen::Vector2d on_border = corner_px + along_m / map.grid.metres_per_pixel * light;
    lit += lightness_at(map, on_border + aside);
    dark += lightness_at(map, on_border - aside);
  }
  return (lit - dark) / std::max(lit + dark, 1.0);
}

// The contrast over both borders of the shadow that the region would cast.
double border_contrast(const Region& region, const RegionMap& map, double azimuth_deg) {
  const Eigen::Vector2d away = shadow_direction({azimuth_deg, 45});
  const Eigen::Vector2d light(away.x(), -away.y());
  const Eigen::Vector2d across(-light.y(), light.x());
  const auto [first, last] = std::minmax_element(
      region.outline.begin(), region.outline.end(),
      [&](const auto& a, const auto& b) { return across.dot(a.at_px) < across.dot(b.at_px); });
  return border_contrast(map, first->at_px, light, -across) +
         border_contrast(map, last->at_px, light, across);
}

}  // namespace

void SunEvidence::add(const RegionMap& map) {
  for (const Region& region : map.regions) {
    if (!may_be_roof(region)) continue;
    const Eigen::Vector2d sides = shaded_sides_of(region, map);
    const double shaded_m = sides.norm();
    if (shaded_m <= 0) continue;
    shaded_sides_ += sides;
    shaded_m_ += shaded_m;
    for (int i = 0; i < kDirections; ++i) {
      borders_[i] += shaded_m * border_contrast(region, map, i * kDegPerDirection);
    }
  }
}

std::optional<double> SunEvidence::rough_azimuth_deg() const {
  if (shaded_m_ <= 0 || shaded_sides_.norm() < kMinAgreement * shaded_m_) return std::nullopt;
  return wrapped_360(std::atan2(-shaded_sides_.x(), -shaded_sides_.y()) / kRadPerDeg);
}

double SunEvidence::border_at(int direction) const {
  double sum = 0;
  for (int i = -kSmoothing; i <= kSmoothing; ++i) {
    sum += (kSmoothing + 1 - std::abs(i)) * borders_[(direction + i + kDirections) % kDirections];
  }
  return sum;
}

std::optional<double> SunEvidence::azimuth_deg() const {
  const std::optional<double> rough_deg = rough_azimuth_deg();
  if (!rough_deg) return std::nullopt;
  const int middle = static_cast<int>(std::lround(*rough_deg / kDegPerDirection));
  int best = middle;
  double most = border_at(middle % kDirections);
  for (int i = middle - kSearched; i <= middle + kSearched; ++i) {
    const double border = border_at((i + kDirections) % kDirections);
    if (border <= most) continue;
    most = border;
    best = i;
  }
  return wrapped_360(best * kDegPerDirection);
}

}  // namespace milepost
