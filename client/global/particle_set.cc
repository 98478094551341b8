#include "client/global/particle_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "client/estimation/resampling.h"

namespace milepost {

Pose2 uniform_pose(const PlanBox& area, Random& random) {
  std::uniform_real_distribution<double> east(area.min_m.x(), area.max_m.x());
  std::uniform_real_distribution<double> north(area.min_m.y(), area.max_m.y());
  std::uniform_real_distribution<double> heading(0, 2 * std::numbers::pi);
  Pose2 pose;
  pose.enu_m.x() = east(random);
  pose.enu_m.y() = north(random);
  pose.heading_rad = heading(random);
  return pose;
}

ParticleSet uniform_particles(std::size_t count, const PlanBox& area, Random& random) {
  ParticleSet particles;
  particles.reserve(count);
  const double weight = 1.0 / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) particles.push_back({uniform_pose(area, random), weight});
  return particles;
}

ParticleSet particles_about(const StartBelief& start, std::size_t count, Random& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any(0, 2 * std::numbers::pi);
  ParticleSet particles;
  particles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Pose2 pose = start.pose;
    pose.enu_m.x() += start.sigma_m * normal(random);
    pose.enu_m.y() += start.sigma_m * normal(random);
    pose.heading_rad = start.heading_sigma_rad < std::numbers::pi
                           ? pose.heading_rad + start.heading_sigma_rad * normal(random)
                           : any(random);
    particles.push_back({pose, 1.0 / static_cast<double>(count)});
  }
  return particles;
}

std::size_t propagate(ParticleSet& particles, const OdometryIncrement& motion,
                      const MotionNoise& noise, const RayCastingGrid& walls, const PlanBox& area,
                      Crossing crossing, Random& random) {
  std::normal_distribution<double> normal;
  const double root_s = std::sqrt(motion.duration_s);
  const double along_sigma_m =
      std::hypot(noise.along_m * root_s, noise.along_part * motion.distance_m);
  const double scale_sigma = noise.scale * std::sqrt(std::abs(motion.distance_m));
  const double turn_sigma_rad = noise.turn_rad * root_s;
  std::size_t crossed = 0;
  ParticleSet others;
  for (Particle& particle : particles) {
    const Pose2 before = particle.pose;
    particle.odometry_scale += scale_sigma * normal(random);
    const double along_m =
        particle.odometry_scale * motion.distance_m + along_sigma_m * normal(random);
    const double turn_rad = motion.turn_rad + turn_sigma_rad * normal(random);
    particle.pose = moved(before, along_m, turn_rad);
    if (area.contains(particle.pose.enu_m) &&
        !walls.is_crossed(before.enu_m, particle.pose.enu_m)) {
      if (crossing == Crossing::dropped) others.push_back(particle);
      continue;
    }
    if (crossing == Crossing::drawn_anew) particle.pose = uniform_pose(area, random);
    ++crossed;
  }
  if (others.empty()) return crossed;
  normalize(others);
  particles = std::move(others);
  return crossed;
}

void normalize(ParticleSet& particles) {
  double total = 0;
  for (const Particle& particle : particles) total += particle.weight;
  for (Particle& particle : particles) particle.weight /= total;
}

double update_weights(ParticleSet& particles, const std::vector<double>& log_likelihoods) {
  const double best = *std::ranges::max_element(log_likelihoods);
  double total = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles[i].weight *= std::exp(log_likelihoods[i] - best);
    total += particles[i].weight;
  }
  for (Particle& particle : particles) particle.weight /= total;
  return best + std::log(total);
}

void draw_odometry_scales(ParticleSet& particles, double sigma, Random& random) {
  std::normal_distribution<double> scale(1, sigma);
  for (Particle& particle : particles) particle.odometry_scale = scale(random);
}

void jitter(ParticleSet& particles, double sigma_m, double sigma_rad, Random& random) {
  std::normal_distribution<double> normal;
  for (Particle& particle : particles) {
    particle.pose.enu_m.x() += sigma_m * normal(random);
    particle.pose.enu_m.y() += sigma_m * normal(random);
    particle.pose.heading_rad += sigma_rad * normal(random);
  }
}

double effective_count(const ParticleSet& particles) {
  double squares = 0;
  for (const Particle& particle : particles) squares += particle.weight * particle.weight;
  return 1 / squares;
}

ParticleSet resampled(const ParticleSet& particles, std::size_t count, Random& random) {
  const double weight = 1.0 / static_cast<double>(count);
  ParticleSet chosen;
  chosen.reserve(count);
  resample_systematically(
      particles.size(), [&](std::size_t i) { return particles[i].weight; }, 1.0, count, random,
      [&](std::size_t i) {
        chosen.push_back({particles[i].pose, weight, particles[i].odometry_scale});
      });
  return chosen;
}

std::size_t enough_particles(const ParticleSet& particles, double bin_m, double bin_rad) {
  constexpr double kError = 0.05;
  constexpr double kQuantile = 2.33;  // of the normal distribution, at 0.99
  constexpr std::size_t kLeast = 200;
  std::set<std::array<long, 3>> bins;
  for (const Particle& particle : particles) {
    const double heading_rad = std::remainder(particle.pose.heading_rad, 2 * std::numbers::pi);
    bins.insert({std::lround(particle.pose.enu_m.x() / bin_m),
                 std::lround(particle.pose.enu_m.y() / bin_m), std::lround(heading_rad / bin_rad)});
  }
  if (bins.size() < 2) return kLeast;
  const auto k = static_cast<double>(bins.size() - 1);
  const double root = 1 - 2 / (9 * k) + std::sqrt(2 / (9 * k)) * kQuantile;
  const double enough = k / (2 * kError) * root * root * root;
  return std::max(kLeast, static_cast<std::size_t>(std::ceil(enough)));
}

}  // namespace milepost
