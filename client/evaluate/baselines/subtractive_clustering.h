// Subtractive clustering (Chiu, 1994) of points on the Gaussian sphere, as the aerial paper finds
// vanishing directions (section III).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace milepost {

struct ClusteringSettings {
  double radius_rad = 0.1;     // Chiu's r_a: of the neighbourhood that makes a point's potential
  double squash = 1.5;         // Chiu's r_b / r_a: how much further a centre lowers potentials
  double accept_share = 0.5;   // of the first potential: from here on a point is a centre
  double reject_share = 0.15;  // below here none is; between, centres must be far apart
  std::size_t max_centres = 4;
};

// The centres of the densest places, the densest first; each is one of the points, which are unit
// vectors that stand for their opposites too. Takes time as the square of their number.
std::vector<Eigen::Vector3d> cluster_centres(std::span<const Eigen::Vector3d> points,
                                             const ClusteringSettings& settings);

}  // namespace milepost
