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

Bin bin_of(const PlanPose& pose, const ModeKernel& kernel) {
  const double turns = pose.heading_rad / (2 * std::numbers::pi);
  const double heading_rad = (turns - std::floor(turns)) * 2 * std::numbers::pi;
  return {static_cast<int>(std::floor(pose.enu_m.x() / kernel.radius_m)),
          static_cast<int>(std::floor(pose.enu_m.y() / kernel.radius_m)),
          static_cast<int>(std::floor(heading_rad / (2 * kernel.heading_rad)))};
}

// A pose in each of the bins with the most weight.
std::vector<PlanPose> starts_in(const ParticleCloud& cloud, const ModeKernel& kernel) {
  struct Heap {
    double weight = 0;
    const Particle* heaviest = nullptr;
  };
  std::map<Bin, Heap> bins;
  for (const Particle& particle : cloud) {
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
  std::vector<PlanPose> starts;
  starts.reserve(heaps.size());
  for (const Heap& heap : heaps) starts.push_back(heap.heaviest->pose);
  return starts;
}

BeliefMode mode_about(const PlanPose& centre, const ParticleCloud& cloud,
                      const ModeKernel& kernel) {
  const auto turn_rad = [&](const Particle& particle) {
    return std::remainder(particle.pose.heading_rad - centre.heading_rad, 2 * std::numbers::pi);
  };
  double mass = 0;
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
  double sum_m2 = 0;
  double sum_rad = 0;
  double sum_rad2 = 0;
  double sum_scale = 0;
  for (const Particle& particle : cloud) {
    const Eigen::Vector2d off_m = particle.pose.enu_m - centre.enu_m;
    const double turn = turn_rad(particle);
    if (off_m.norm() > kernel.radius_m || std::abs(turn) > kernel.heading_rad) continue;
    mass += particle.weight;
    sum_m += particle.weight * off_m;
    sum_m2 += particle.weight * off_m.squaredNorm();
    sum_rad += particle.weight * turn;
    sum_rad2 += particle.weight * turn * turn;
    sum_scale += particle.weight * particle.wheel_scale;
  }
  BeliefMode mode{centre, mass, 0, 0};
  if (mass <= 0) return mode;
  const Eigen::Vector2d mean_m = sum_m / mass;
  const double mean_rad = sum_rad / mass;
  mode.pose.enu_m += mean_m;
  mode.pose.heading_rad += mean_rad;
  mode.wheel_scale = sum_scale / mass;
  mode.sigma_m = std::sqrt(std::max(0.0, (sum_m2 / mass - mean_m.squaredNorm()) / 2));
  mode.heading_sigma_rad = std::sqrt(std::max(0.0, sum_rad2 / mass - mean_rad * mean_rad));
  return mode;
}

}  // namespace

BeliefMode densest_mode(const ParticleCloud& cloud, const ModeKernel& kernel) {
  BeliefMode best;
  for (PlanPose pose : starts_in(cloud, kernel)) {
    BeliefMode mode = mode_about(pose, cloud, kernel);
    for (int i = 0; i < kMaxShifts; ++i) {
      const double shift_m = (mode.pose.enu_m - pose.enu_m).norm();
      pose = mode.pose;
      mode = mode_about(pose, cloud, kernel);
      if (shift_m < kSettledM) break;
    }
    if (mode.mass > best.mass) best = mode;
  }
  return best;
}

}  // namespace milepost
