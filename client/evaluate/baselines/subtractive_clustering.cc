#include "client/evaluate/baselines/subtractive_clustering.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace milepost {
namespace {

// Of the chord between the points or between one and the other's opposite, whichever is shorter.
double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::max(0.0, 2 * (1 - std::abs(a.dot(b))));
}

double closeness(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) {
  return std::exp(-4 * squared_distance(a, b) / (radius * radius));
}

// Chiu's Eq. 1.
std::vector<double> potentials_of(std::span<const Eigen::Vector3d> points, double radius) {
  std::vector<double> potentials(points.size(), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const double share = closeness(points[i], points[j], radius);
      potentials[i] += share;
      potentials[j] += share;
    }
  }
  return potentials;
}

double distance_to_nearest(const Eigen::Vector3d& point, std::span<const Eigen::Vector3d> centres) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& centre : centres) {
    nearest = std::min(nearest, std::sqrt(squared_distance(point, centre)));
  }
  return nearest;
}

}  // namespace

std::vector<Eigen::Vector3d> cluster_centres(std::span<const Eigen::Vector3d> points,
                                             const ClusteringSettings& settings) {
  std::vector<Eigen::Vector3d> centres;
  if (points.empty()) return centres;
  std::vector<double> potentials = potentials_of(points, settings.radius_rad);
  const double first = *std::max_element(potentials.begin(), potentials.end());
  while (centres.size() < settings.max_centres) {
    const auto highest = std::max_element(potentials.begin(), potentials.end());
    const Eigen::Vector3d& point = points[highest - potentials.begin()];
    const double share = *highest / first;
    if (share < settings.reject_share) break;
    const double apart = distance_to_nearest(point, centres) / settings.radius_rad;
    if (share < settings.accept_share && apart + share < 1) {
      *highest = 0;  // too near to an existing centre
      continue;
    }
    const double height = *highest;
    centres.push_back(point);
    for (std::size_t i = 0; i < points.size(); ++i) {  // Chiu's Eq. 2
      potentials[i] -= height * closeness(points[i], point, settings.squash * settings.radius_rad);
    }
  }
  return centres;
}

}  // namespace milepost
