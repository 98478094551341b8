// Subtractive clustering (Chiu, 1994) of points on the Gaussian sphere, used by the aerial paper to
// find vanishing directions (section III).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace milepost {

struct ClusteringSettings {
  double radius_rad = 0.1;     // Chiu's r_a: neighbourhood of a point's potential
  double squash = 1.5;         // Chiu's r_b / r_a: relative reach of a centre
  double accept_share = 0.5;   // of the first potential: from here on a point is a centre
  double reject_share = 0.15;  // below this none is; between, centres must be far apart
  std::size_t max_centres = 4;
};

// The centres of the densest clusters, the densest first. Each is one of the points, which are unit
// vectors equivalent to their opposites. Quadratic in the number of points.
std::vector<Eigen::Vector3d> cluster_centres(std::span<const Eigen::Vector3d> points,
                                             const ClusteringSettings& settings);

}  // namespace milepost
