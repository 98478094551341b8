// The particle filter of the aerial paper, section IV: where a vehicle is among the walls of an
// area, from what its frames tell of walls and from its wheels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/global/contest.h"
#include "client/global/mode_watch.h"
#include "client/global/particle_cloud.h"
#include "client/global/sight_history.h"
#include "client/global/wall_index.h"
#include "client/global/wall_observer.h"

namespace milepost {

enum class FindMethod {
  orientations,  // the paper's: wall orientations by bearing, Eqs. 2 to 4
  combined,      // ours (decision 22): these, and how far away what is seen stands
};

struct FilterSettings {
  FindMethod method = FindMethod::combined;
  std::size_t particles = 2000;
  std::uint64_t seed = 1;
  std::optional<StartBelief> start;  // none: anywhere in the area
  double view_reach_m = 60;          // walls farther away are not seen
  WatchSettings watch;
  HistorySettings history;
};

// The answer for one frame.
struct Found {
  FindStatus status = FindStatus::initializing;
  BeliefMode mode;       // where the belief is densest, whatever the status
  double explained = 0;  // share of what was seen lately that the walls there explain
};

// Not safe to use from several threads at once. The same observations, motions and settings give
// the same answers.
class WallFilter {
 public:
  // The walls must live as long as the filter. REQUIRES: particles > 0; the area is not empty.
  WallFilter(const WallIndex& walls, const PlanBox& area, const FilterSettings& settings);

  // `motion` is that since the last call.
  Found update(const WallObservation& observation, const WheelMotion& motion);

  const ParticleCloud& particles() const { return cloud_; }

 private:
  void weigh_by_importance(const WallObservation& observation);
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

}  // namespace milepost
