// Search and refinement of the direction that most great circles pass through.
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

// Prior knowledge of a direction: it is perpendicular to `axis`, with this standard deviation.
struct SquareTo {
  Eigen::Vector3d axis;
  double sigma_rad = 0;
};

// normal . direction| in standard deviations: the misfit of a line to a vanishing direction.
double misfit_sigmas(const GreatCircle& circle, const Eigen::Vector3d& direction);

// Beyond this misfit a line does not belong to a direction.
inline constexpr double kMaxMisfitSigmas = 3;

// The log-likelihood ratio of a direction by the circles, in nats: each fitting circle counts by
// how improbable its fit is by chance, decreasing to 0 at kMaxMisfitSigmas.
double likelihood(std::span<const GreatCircle> circles, const Eigen::Vector3d& direction);

// The intersection of two of the first `pairs_of` circles with the highest likelihood among the
// allowed ones; none if no two intersect there.
std::optional<Eigen::Vector3d> strongest_direction(
    std::span<const GreatCircle> circles, std::size_t pairs_of,
    const std::function<bool(const Eigen::Vector3d&)>& is_allowed);

// The direction near `start` that minimizes the robust (Geman-McClure) sum of squared misfits, by
// iteratively reweighted least squares; `knowledge` counts as circles without outliers.
Eigen::Vector3d refined_direction(std::span<const GreatCircle> circles,
                                  std::span<const SquareTo> knowledge,
                                  const Eigen::Vector3d& start);

}  // namespace milepost
