// The map data that a localizer wants, in the order in which it matters.
#pragma once

#include <memory>

#include "client/fetch/held_map.h"
#include "client/fetch/wants.h"
#include "client/localize/expected_route.h"
#include "schema/base/range.h"

namespace milepost {

// In the order in which they are fetched; what is less likely of one comes with the next.
enum class WantedFor : int { this_frame, next_frames, a_restart, the_way_ahead };

class WantedMap {
 public:
  // REQUIRES: both outlive it.
  WantedMap(const HeldMap& held, const ExpectedRoute& route) : held_(held), route_(route) {}

  void add(const SegmentKey& segment, const AlongRange& range, WantedFor use);
  // A range of the way that a segment is on: behind, and ahead on all branches. The branch that the
  // route takes comes first; without a route, the one that the segment's own drive took.
  void add_way(const std::shared_ptr<const SegmentLayer>& segment, const AlongRange& range,
               WantedFor use);
  void set_surroundings(const Surroundings& around) { wants_.around = around; }

  const Wants& wants() const { return wants_; }

 private:
  void add_unknown(const SegmentLayer& from, const AlongRange& beyond, int priority);

  const HeldMap& held_;
  const ExpectedRoute& route_;
  Wants wants_;
};

}  // namespace milepost
