#include "client/global/orientation_importance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// psi_r is evaluated in the middle of parts of a section, which are at most this wide.
constexpr double kPartRad = 5 * kRadPerDeg;

// eta_e of Eq. 2 for the part of a section around one bearing.
double similarity_at(const Pose2& pose, double bearing_rad, const ViewSection& section,
                     const RayCastingGrid& walls, double reach_m) {
  const auto hit =
      walls.first_hit(pose.enu_m, direction_of(pose.heading_rad + bearing_rad), reach_m);
  if (!hit) return 0;
  const double expected_rad = walls.walls()[hit->wall].azimuth_rad() - pose.heading_rad;
  double best = 0;
  for (const double observed_rad : section.orientations_rad) {
    best = std::max(best, similarity(angle_between_orientations_rad(observed_rad, expected_rad)));
  }
  return best;
}

}  // namespace

double angle_between_orientations_rad(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, std::numbers::pi));
}

double similarity(double angle_rad) {
  return 1 - 1 / (1 + std::exp((20 - angle_rad / kRadPerDeg) / 2));
}

double orientation_importance(const Pose2& pose, std::span<const ViewSection> sections,
                              const RayCastingGrid& walls, double reach_m) {
  double weighted = 0;
  double total_rad = 0;
  for (const ViewSection& section : sections) {
    const double width_rad = section.bearings.width_rad();
    total_rad += width_rad;
    const int parts = static_cast<int>(std::ceil(width_rad / kPartRad));
    for (int k = 0; k < parts; ++k) {
      const double bearing_rad = section.bearings.from_rad + width_rad * (k + 0.5) / parts;
      weighted += width_rad / parts * similarity_at(pose, bearing_rad, section, walls, reach_m);
    }
  }
  return total_rad > 0 ? weighted / total_rad : 0;
}

}  // namespace milepost
