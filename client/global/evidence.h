// What an observation says for a pose, by both ways of seeing walls: how far away they stand and
// how they are turned (decision 22).
#pragma once

#include "client/global/particle_cloud.h"
#include "client/global/plan_pose.h"
#include "client/global/range_agreement.h"
#include "client/global/wall_index.h"
#include "client/global/wall_observer.h"

namespace milepost {

// Broad while few particles have to cover an area, sharp about a place that is found.
inline constexpr RangeSettings kBroadRanges{1.5, 0.05};
inline constexpr RangeSettings kSharpRanges{0.5, 0.02};

// However far it went since the last frame that showed something, this is no more news.
inline constexpr double kMaxEvidenceWayM = 5;
// How much a frame says of poses that were proposed by it.
inline constexpr double kCandidateWayM = 4;

struct EvidenceSettings {
  RangeSettings ranges;
  double per_beam = 0.03;         // the part of what a beam says that counts, for a metre of way
  double least_per_beam = -1.3;   // on the average of a frame: among trees no pose is to blame
  double orientations = 0.5;      // the part of what these say that counts, for a metre of way
  double least_importance = 0.1;  // of a pose whose orientations do not agree at all
  double view_reach_m = 60;       // orientations of walls farther away are not seen
};

// Log-likelihood for each metre of way over which such observations are made: points seen in frame
// after frame on the same walls, by the same wheels, are hardly news.
double evidence_per_m(const PlanPose& pose, double wheel_scale, const WallObservation& observation,
                      const WallIndex& walls, const EvidenceSettings& settings);

// Weighs a cloud by what an observation says over so many metres of way. One without beams says
// nothing.
void weigh_by_evidence(ParticleCloud& cloud, const WallObservation& observation, double way_m,
                       const WallIndex& walls, const EvidenceSettings& settings);

}  // namespace milepost
