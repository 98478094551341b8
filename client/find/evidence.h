// What an observation says for a pose, by both ways of seeing walls: how far away they stand and
// how they are turned (decision 22).
#pragma once

#include "client/find/plan_pose.h"
#include "client/find/range_agreement.h"
#include "client/find/wall_index.h"
#include "client/find/wall_observer.h"

namespace milepost {

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

}  // namespace milepost
