// The log-likelihood of an observation for a pose, by both kinds of wall measurements: ranges and
// orientations (decision 22).
#pragma once

#include "client/global/particle_set.h"
#include "client/global/pose2.h"
#include "client/global/range_likelihood.h"
#include "client/global/ray_casting_grid.h"
#include "client/global/wall_observer.h"

namespace milepost {

// Broad while few particles have to cover an area, sharp around a converged mode.
inline constexpr RangeSettings kBroadRanges{1.5, 0.05};
inline constexpr RangeSettings kSharpRanges{0.5, 0.02};

// Upper bound of the distance since the last measurement that a frame counts for.
inline constexpr double kMaxLikelihoodDistanceM = 5;
// The distance that a frame counts for when it weighs poses that it proposed.
inline constexpr double kProposalDistanceM = 4;

struct WallLikelihoodSettings {
  RangeSettings ranges;
  double per_beam = 0.03;         // weight of a beam's log-likelihood, per metre travelled
  double least_per_beam = -1.3;   // lower bound of a frame's average: among trees no pose fits
  double orientations = 0.5;      // weight of the orientations' log-likelihood, per metre travelled
  double least_importance = 0.1;  // of a pose without any agreement
  double view_reach_m = 60;       // orientations of walls farther away are not visible
};

// The log-likelihood per metre travelled while such observations are made: consecutive frames
// observe the same walls with the same odometry and are hardly independent.
double log_likelihood_per_m(const Pose2& pose, double odometry_scale,
                            const WallObservation& observation, const RayCastingGrid& walls,
                            const WallLikelihoodSettings& settings);

// Updates the weights with an observation that counts for a distance travelled. An observation
// without beams changes nothing.
void measurement_update(ParticleSet& particles, const WallObservation& observation,
                        double distance_m, const RayCastingGrid& walls,
                        const WallLikelihoodSettings& settings);

}  // namespace milepost
