// Our particle filter among the walls of an area (decision 22): the aerial paper's, section IV,
// with how far away what is seen stands beside the orientations of walls, frames weighed by the way
// driven, and a contest between places.
#pragma once

#include <optional>

#include "client/global/contest.h"
#include "client/global/plan_filter.h"
#include "client/global/sight_history.h"

namespace milepost {

class WallFilter : public PlanFilter {
 public:
  WallFilter(const WallIndex& walls, const PlanBox& area, const FilterSettings& settings);

  Found update(const WallObservation& observation, const WheelMotion& motion) override;

  const ParticleCloud& particles() const override { return cloud_; }

 private:
  void weigh_by_way(const WallObservation& observation, double way_m);
  void start_from(const WallObservation& observation);
  std::optional<double> explained_by(const BeliefMode& mode,
                                     const WallObservation& observation) const;
  bool is_rivalled() const;
  bool is_challenged() const;
  void resample();

  const WallIndex& walls_;
  PlanBox area_;
  FilterSettings settings_;
  Random random_;
  ParticleCloud cloud_;
  ModeWatch watch_;
  SightHistory history_;
  Contest contest_;
  bool is_started_ = false;  // from a first observation
  double way_m_ = 0;         // since beams were weighed
};

FindMethod combined_method();

}  // namespace milepost
