// The interface of particle filters among the walls of an area, which global localization methods
// implement.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "client/global/convergence_monitor.h"
#include "client/global/particle_set.h"
#include "client/global/ray_casting_grid.h"
#include "client/global/wall_observer.h"

namespace milepost {

struct FilterSettings {
  std::size_t particles = 2000;
  std::uint64_t seed = 1;
  std::optional<StartBelief> start;  // none: anywhere in the area
  double view_reach_m = 60;          // walls farther away are not visible
  ConvergenceSettings convergence;
};

// The estimate for one frame.
struct PlanEstimate {
  GlobalStatus status = GlobalStatus::initializing;
  BeliefMode mode;          // the densest mode, whatever the status
  double inlier_ratio = 0;  // share of recent measurements that the walls at the mode explain
};

// Not safe to use from several threads at once. The same observations, motions and settings give
// the same estimates.
class PlanFilter {
 public:
  virtual ~PlanFilter() = default;

  // `motion` is the odometry since the last call.
  virtual PlanEstimate update(const WallObservation& observation,
                              const OdometryIncrement& motion) = 0;

  virtual const ParticleSet& particles() const = 0;
};

// REQUIRES: the walls outlive the filter; particles > 0; the area is not empty.
using MakePlanFilter = std::function<std::unique_ptr<PlanFilter>(
    const RayCastingGrid& walls, const PlanBox& area, const FilterSettings& settings)>;

template <class Filter>
std::unique_ptr<PlanFilter> make_plan_filter(const RayCastingGrid& walls, const PlanBox& area,
                                             const FilterSettings& settings) {
  return std::make_unique<Filter>(walls, area, settings);
}

struct GlobalMethod {
  bool with_beams = true;  // whether the filter uses beams; they take half of a frame's time
  MakePlanFilter make_filter;
};

// The initial particles of a filter.
ParticleSet initial_particles(const FilterSettings& settings, const PlanBox& area, Random& random);

// The settings with less distance to converge if the start is known, since no similar street has to
// be excluded.
ConvergenceSettings convergence_settings(const FilterSettings& settings);

// Whether the vehicle moves: at standstill noise would only spread the particles.
bool is_moving(const OdometryIncrement& motion);

}  // namespace milepost
