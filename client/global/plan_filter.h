// What a filter among the walls of an area is: the seam behind which the ways to find a vehicle
// stand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "client/global/mode_watch.h"
#include "client/global/particle_cloud.h"
#include "client/global/wall_index.h"
#include "client/global/wall_observer.h"

namespace milepost {

struct FilterSettings {
  std::size_t particles = 2000;
  std::uint64_t seed = 1;
  std::optional<StartBelief> start;  // none: anywhere in the area
  double view_reach_m = 60;          // walls farther away are not seen
  WatchSettings watch;
};

// The answer for one frame.
struct Found {
  FindStatus status = FindStatus::initializing;
  BeliefMode mode;       // where the belief is densest, whatever the status
  double explained = 0;  // share of what was seen lately that the walls there explain
};

// Not safe to use from several threads at once. The same observations, motions and settings give
// the same answers.
class PlanFilter {
 public:
  virtual ~PlanFilter() = default;

  // `motion` is that since the last call.
  virtual Found update(const WallObservation& observation, const WheelMotion& motion) = 0;

  virtual const ParticleCloud& particles() const = 0;
};

// The walls must live as long as the filter. REQUIRES: particles > 0; the area is not empty.
using MakePlanFilter = std::function<std::unique_ptr<PlanFilter>(
    const WallIndex& walls, const PlanBox& area, const FilterSettings& settings)>;

template <class Filter>
std::unique_ptr<PlanFilter> make_plan_filter(const WallIndex& walls, const PlanBox& area,
                                             const FilterSettings& settings) {
  return std::make_unique<Filter>(walls, area, settings);
}

struct FindMethod {
  bool with_beams = true;  // whether the filter uses them; they take half of a frame's time
  MakePlanFilter make_filter;
};

// The particles of a filter at first. `settings` are its own.
ParticleCloud first_cloud(const FilterSettings& settings, const PlanBox& area, Random& random);

// Where the start is known no other street is meant, and less way is enough to be found.
WatchSettings watch_settings(const FilterSettings& settings);

// Standing still, particles stay: noise would only spread them.
bool is_moving(const WheelMotion& motion);

}  // namespace milepost
