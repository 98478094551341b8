// The particles of the filter (the aerial paper, section IV): poses with weights.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "client/global/plan_pose.h"
#include "client/global/wall_index.h"

namespace milepost {

struct Particle {
  PlanPose pose;
  double weight = 0;
  double wheel_scale = 1;  // metres that it goes for each metre that the wheels tell
};

// Weights of a cloud add up to 1.
using ParticleCloud = std::vector<Particle>;

// A start that is known so far: normal about a pose. A heading sigma of pi or more means any.
struct StartBelief {
  PlanPose pose;
  double sigma_m = 0;  // in each direction
  double heading_sigma_rad = 0;
};

// Standard deviations of a step.
struct MotionNoise {
  double along_m = 0;     // per root of a second
  double along_part = 0;  // of its distance
  double turn_rad = 0;    // per root of a second
  double scale = 0;       // of the wheels, per root of a metre
};

using Random = std::mt19937_64;

// A pose anywhere in the box, in any direction.
PlanPose uniform_pose(const PlanBox& area, Random& random);

ParticleCloud uniform_cloud(std::size_t count, const PlanBox& area, Random& random);
ParticleCloud cloud_about(const StartBelief& start, std::size_t count, Random& random);

// What becomes of a particle that goes through a wall or leaves the area.
enum class Crossing {
  drawn_anew,  // anywhere in the area: the paper's, for a vehicle that may be anywhere
  dropped,     // its weight goes to the others; for one that is known to be about a place
};

// Eq. 1 for each particle, with noise of its own. Returns how many crossed a wall or the border.
// Where all do, none is dropped.
std::size_t move_cloud(ParticleCloud& cloud, const WheelMotion& motion, const MotionNoise& noise,
                       const WallIndex& walls, const PlanBox& area, Crossing crossing,
                       Random& random);

// Multiplies weights by e^log_likelihoods[i] and makes them add up to 1. The log of the cloud's own
// likelihood: of the weighted mean, where the weights added up to 1 before.
double weigh_cloud(ParticleCloud& cloud, const std::vector<double>& log_likelihoods);

// Makes the weights add up to 1. REQUIRES: their sum is above 0.
void normalize(ParticleCloud& cloud);

// Draws the wheels' scale of each particle about 1.
void draw_wheel_scales(ParticleCloud& cloud, double sigma, Random& random);

// Moves each particle by noise of its own.
void scatter_cloud(ParticleCloud& cloud, double sigma_m, double sigma_rad, Random& random);

// 1 / sum of squared weights: how many particles carry the belief.
double effective_count(const ParticleCloud& cloud);

// Low-variance sampling (Thrun, Burgard and Fox, Probabilistic Robotics, 2005): `count` particles
// of equal weight by one random number.
ParticleCloud resampled(const ParticleCloud& cloud, std::size_t count, Random& random);

// How many particles tell a belief that fills so many bins of the plan and of headings as the cloud
// does, with an error of less than 0.05 in 99 of 100 cases; at least 200 (KLD sampling: Fox, IJRR
// 22, 2003).
std::size_t enough_particles(const ParticleCloud& cloud, double bin_m, double bin_rad);

}  // namespace milepost
