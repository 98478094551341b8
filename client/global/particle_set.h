// The particles of the filter (the aerial paper, section IV): weighted SE(2) poses.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "client/global/pose2.h"
#include "client/global/ray_casting_grid.h"

namespace milepost {

struct Particle {
  Pose2 pose;
  double weight = 0;
  double odometry_scale = 1;  // true distance per metre of odometry
};

// The weights add up to 1.
using ParticleSet = std::vector<Particle>;

// A normal prior of the initial pose. A heading sigma of pi or more means a uniform heading.
struct StartBelief {
  Pose2 pose;
  double sigma_m = 0;  // per axis
  double heading_sigma_rad = 0;
};

// Standard deviations of a motion step.
struct MotionNoise {
  double along_m = 0;     // per square root of a second
  double along_part = 0;  // relative to its distance
  double turn_rad = 0;    // per square root of a second
  double scale = 0;       // of odometry_scale, per square root of a metre
};

using Random = std::mt19937_64;

// A pose with uniformly distributed position in the box and uniform heading.
Pose2 uniform_pose(const PlanBox& area, Random& random);

ParticleSet uniform_particles(std::size_t count, const PlanBox& area, Random& random);
ParticleSet particles_about(const StartBelief& start, std::size_t count, Random& random);

// The treatment of a particle that crosses a wall or leaves the area.
enum class Crossing {
  drawn_anew,  // uniformly in the area: the paper's, for a vehicle without a prior
  dropped,     // its weight goes to the others; for a vehicle with a prior
};

// Applies Eq. 1 with independent noise to each particle. Returns how many crossed a wall or the
// border of the area. If all do, none is dropped.
std::size_t propagate(ParticleSet& particles, const OdometryIncrement& motion,
                      const MotionNoise& noise, const RayCastingGrid& walls, const PlanBox& area,
                      Crossing crossing, Random& random);

// Multiplies the weights by exp(log_likelihoods[i]) and normalizes them. Returns the log-likelihood
// of the set: of the weighted mean, if the weights were normalized before.
double update_weights(ParticleSet& particles, const std::vector<double>& log_likelihoods);

// Normalizes the weights to a sum of 1. REQUIRES: their sum is above 0.
void normalize(ParticleSet& particles);

// Draws the odometry scale of each particle from a normal distribution with mean 1.
void draw_odometry_scales(ParticleSet& particles, double sigma, Random& random);

// Adds independent noise to each pose.
void jitter(ParticleSet& particles, double sigma_m, double sigma_rad, Random& random);

// The effective sample size: 1 / sum of squared weights.
double effective_count(const ParticleSet& particles);

// Low-variance resampling (Thrun, Burgard and Fox, Probabilistic Robotics, 2005): `count` particles
// of equal weight from one random number.
ParticleSet resampled(const ParticleSet& particles, std::size_t count, Random& random);

// The number of particles that represents a belief with as many occupied bins of position and
// heading as the set has, with an error of less than 0.05 in 99 of 100 cases; at least 200 (KLD
// sampling: Fox, IJRR 22, 2003).
std::size_t enough_particles(const ParticleSet& particles, double bin_m, double bin_rad);

}  // namespace milepost
