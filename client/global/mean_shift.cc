#include "client/global/mean_shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace milepost {
namespace {

constexpr std::size_t kStarts = 5;
constexpr int kMaxShifts = 30;
constexpr double kSettledM = 0.01;

using Bin = std::array<int, 3>;

Bin bin_of(const Pose2& pose, const ModeKernel& kernel) {
  const double turns = pose.heading_rad / (2 * std::numbers::pi);
  const double heading_rad = (turns - std::floor(turns)) * 2 * std::numbers::pi;
  return {static_cast<int>(std::floor(pose.enu_m.x() / kernel.radius_m)),
          static_cast<int>(std::floor(pose.enu_m.y() / kernel.radius_m)),
          static_cast<int>(std::floor(heading_rad / (2 * kernel.heading_rad)))};
}

// The heaviest particle's pose in each of the bins with the most weight.
std::vector<Pose2> starts_in(const ParticleSet& particles, const ModeKernel& kernel) {
  struct Heap {
    double weight = 0;
    const Particle* heaviest = nullptr;
  };
  std::map<Bin, Heap> bins;
  for (const Particle& particle : particles) {
    Heap& heap = bins[bin_of(particle.pose, kernel)];
    heap.weight += particle.weight;
    if (heap.heaviest == nullptr || particle.weight > heap.heaviest->weight) {
      heap.heaviest = &particle;
    }
  }
  std::vector<Heap> heaps;
  heaps.reserve(bins.size());
  for (const auto& [bin, heap] : bins) heaps.push_back(heap);
  std::ranges::stable_sort(heaps, std::greater{}, &Heap::weight);
  heaps.resize(std::min(heaps.size(), kStarts));
  std::vector<Pose2> starts;
  starts.reserve(heaps.size());
  for (const Heap& heap : heaps) starts.push_back(heap.heaviest->pose);
  return starts;
}

BeliefMode mode_about(const Pose2& centre, const ParticleSet& particles, const ModeKernel& kernel) {
  const auto turn_rad = [&](const Particle& particle) {
    return std::remainder(particle.pose.heading_rad - centre.heading_rad, 2 * std::numbers::pi);
  };
  double mode_probability = 0;
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
  double sum_m2 = 0;
  double sum_rad = 0;
  double sum_rad2 = 0;
  double sum_scale = 0;
  for (const Particle& particle : particles) {
    const Eigen::Vector2d off_m = particle.pose.enu_m - centre.enu_m;
    const double turn = turn_rad(particle);
    if (off_m.norm() > kernel.radius_m || std::abs(turn) > kernel.heading_rad) continue;
    mode_probability += particle.weight;
    sum_m += particle.weight * off_m;
    sum_m2 += particle.weight * off_m.squaredNorm();
    sum_rad += particle.weight * turn;
    sum_rad2 += particle.weight * turn * turn;
    sum_scale += particle.weight * particle.odometry_scale;
  }
  BeliefMode mode{centre, mode_probability, 0, 0};
  if (mode_probability <= 0) return mode;
  const Eigen::Vector2d mean_m = sum_m / mode_probability;
  const double mean_rad = sum_rad / mode_probability;
  mode.pose.enu_m += mean_m;
  mode.pose.heading_rad += mean_rad;
  mode.odometry_scale = sum_scale / mode_probability;
  mode.sigma_m = std::sqrt(std::max(0.0, (sum_m2 / mode_probability - mean_m.squaredNorm()) / 2));
  mode.heading_sigma_rad =
      std::sqrt(std::max(0.0, sum_rad2 / mode_probability - mean_rad * mean_rad));
  return mode;
}

}  // namespace

BeliefMode densest_mode(const ParticleSet& particles, const ModeKernel& kernel) {
  BeliefMode best;
  for (Pose2 pose : starts_in(particles, kernel)) {
    BeliefMode mode = mode_about(pose, particles, kernel);
    for (int i = 0; i < kMaxShifts; ++i) {
      const double shift_m = (mode.pose.enu_m - pose.enu_m).norm();
      pose = mode.pose;
      mode = mode_about(pose, particles, kernel);
      if (shift_m < kSettledM) break;
    }
    if (mode.probability > best.probability) best = mode;
  }
  return best;
}

}  // namespace milepost
