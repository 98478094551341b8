// Which direction the most great circles pass through, and where exactly.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "client/global/gaussian_sphere.h"

namespace milepost {

// Directions at `min_rad` to `max_rad` from `axis`, a unit vector, or from its opposite.
struct Zone {
  Eigen::Vector3d axis;
  double min_rad = 0;
  double max_rad = 0;

  bool contains(const Eigen::Vector3d& direction) const;
};

// What is known of a direction beside the lines: that it is square to `axis`, within sigma_rad.
struct SquareTo {
  Eigen::Vector3d axis;
  double sigma_rad = 0;
};

// normal . direction in standard deviations: how badly a line fits a vanishing direction.
double misfit_sigmas(const GreatCircle& circle, const Eigen::Vector3d& direction);

// Beyond this a line does not belong to a direction.
inline constexpr double kMaxMisfitSigmas = 3;

// The evidence of the circles for a direction, in nats: each one that fits tells as much as the
// fit is improbable by chance, fading out towards kMaxMisfitSigmas.
double evidence(std::span<const GreatCircle> circles, const Eigen::Vector3d& direction);

// The meeting point of two of the first `pairs_of` circles with the most evidence among those
// allowed, or none if no two meet there.
std::optional<Eigen::Vector3d> strongest_direction(
    std::span<const GreatCircle> circles, std::size_t pairs_of,
    const std::function<bool(const Eigen::Vector3d&)>& is_allowed);

// The direction near `start` with the least robust (Geman-McClure) sum of squared misfits, found
// by reweighted least squares; `knowledge` counts as circles without outliers.
Eigen::Vector3d refined_direction(std::span<const GreatCircle> circles,
                                  std::span<const SquareTo> knowledge,
                                  const Eigen::Vector3d& start);

}  // namespace milepost
