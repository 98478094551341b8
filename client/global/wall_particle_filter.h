// Our particle filter among the walls of an area (decision 22): that of the aerial paper, section
// IV, with ranges in addition to wall orientations, frames weighted by the distance travelled, and
// tests of alternative hypotheses.
#pragma once

#include <optional>

#include "client/global/alternative_hypotheses.h"
#include "client/global/measurement_window.h"
#include "client/global/plan_filter.h"

namespace milepost {

class WallParticleFilter : public PlanFilter {
 public:
  WallParticleFilter(const RayCastingGrid& walls, const PlanBox& area,
                     const FilterSettings& settings);

  PlanEstimate update(const WallObservation& observation, const OdometryIncrement& motion) override;

  const ParticleSet& particles() const override { return particles_; }

 private:
  void weigh_by_distance(const WallObservation& observation, double distance_m);
  void start_from(const WallObservation& observation);
  std::optional<double> inlier_ratio_of(const BeliefMode& mode,
                                        const WallObservation& observation) const;
  bool has_alternative() const;
  bool is_tested() const;
  void resample();

  const RayCastingGrid& walls_;
  PlanBox area_;
  FilterSettings settings_;
  Random random_;
  ParticleSet particles_;
  ConvergenceMonitor monitor_;
  MeasurementWindow window_;
  AlternativeHypotheses alternatives_;
  bool is_started_ = false;  // from a first observation
  double distance_m_ = 0;    // since the last update with beams
};

GlobalMethod combined_method();

}  // namespace milepost
