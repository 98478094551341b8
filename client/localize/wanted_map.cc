#include "client/localize/wanted_map.h"

#include <algorithm>

#include "client/localize/unrolled_road.h"

namespace milepost {

void WantedMap::add(const SegmentKey& segment, const AlongRange& range, WantedFor use) {
  wants_.tiles.push_back({segment, range, static_cast<int>(use)});
}

void WantedMap::add_way(const std::shared_ptr<const SegmentLayer>& segment, const AlongRange& range,
                        WantedFor use) {
  const auto road = unrolled_road(held_, segment, range);
  const auto is_on_route = [&](const UnrolledSegment& part) {
    return part.side == RoadSide::ahead && route_.leads_over(*part.layer);
  };
  const bool is_route_known = std::ranges::any_of(road, is_on_route);
  for (const UnrolledSegment& part : road) {
    if (part.side == RoadSide::beside) continue;
    const bool is_turn_known = is_route_known && part.side == RoadSide::ahead;
    const bool is_likely = is_turn_known ? is_on_route(part) : part.is_main_way;
    const int priority = static_cast<int>(use);
    wants_.tiles.push_back(
        {part.layer->key, range.shifted(-part.offset_m), is_likely ? priority : priority + 1});
    add_unknown(*part.layer, range.shifted(-part.extent().to_m), priority + 1);
  }
}

// Successors whose line, or whose map's build, is not known yet. `beyond`: the range from the end
// of `from` on.
void WantedMap::add_unknown(const SegmentLayer& from, const AlongRange& beyond, int priority) {
  if (beyond.to_m < 0) return;
  for (const Successor& successor : from.successors) {
    const auto key = key_of(successor, from, held_);
    const HeldSegment* known = key ? held_.find(*key) : nullptr;
    const bool is_known = known != nullptr && known->layer;
    if (key && !is_known) wants_.tiles.push_back({*key, beyond, priority});
    if (!key) wants_.maps.insert(successor.map);
  }
}

}  // namespace milepost
