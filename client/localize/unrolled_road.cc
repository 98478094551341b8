#include "client/localize/unrolled_road.h"

#include <algorithm>
#include <set>

namespace milepost {
namespace {

std::shared_ptr<const SegmentLayer> layer_held(const HeldMap& held, const SegmentKey& key) {
  const HeldSegment* segment = held.find(key);
  return segment == nullptr ? nullptr : segment->layer;
}

bool leads_to(const SegmentLayer& from, const SegmentKey& to, const HeldMap& held) {
  return std::ranges::any_of(from.successors, [&](const Successor& successor) {
    return successor.segment == to.segment && key_of(successor, from, held) == to;
  });
}

bool is_first_successor(const SegmentLayer& from, const SegmentKey& to, const HeldMap& held) {
  return !from.successors.empty() && key_of(from.successors.front(), from, held) == to;
}

// The arc length of a segment's way at which a successor begins. Their lines, which may be of
// different drives, overlap about the cut.
double begin_of(const SegmentLayer& successor, const SegmentLayer& from) {
  constexpr double kMaxOverlapM = 20;
  const double length_m = from.line.length_m();
  const AlongRange near = {0, std::min(kMaxOverlapM, successor.line.length_m())};
  return length_m - successor.line.project(from.line.point_at(length_m), near).along_m;
}

// The side of a segment that is reached from one on `before` by a step ahead or back.
RoadSide side_after(RoadSide before, bool ahead) {
  if (before == RoadSide::current) return ahead ? RoadSide::ahead : RoadSide::behind;
  const bool goes_on = before == (ahead ? RoadSide::ahead : RoadSide::behind);
  return goes_on ? before : RoadSide::beside;
}

}  // namespace

std::optional<SegmentKey> key_of(const Successor& successor, const SegmentLayer& from,
                                 const HeldMap& held) {
  if (successor.map.empty() || successor.map == from.map())
    return SegmentKey{from.key.version, successor.segment};
  for (const NearbySegment& near : held.around) {
    if (near.version.map == successor.map) return SegmentKey{near.version, successor.segment};
  }
  for (const auto& [key, segment] : held.segments) {
    const bool is_held = segment->layer && key.version.map == successor.map;
    if (is_held) return SegmentKey{key.version, successor.segment};
  }
  const auto current = held.current_maps.find(successor.map);
  if (current != held.current_maps.end()) return SegmentKey{current->second, successor.segment};
  return std::nullopt;
}

std::vector<UnrolledSegment> unrolled_road(const HeldMap& held,
                                           const std::shared_ptr<const SegmentLayer>& current,
                                           const AlongRange& range) {
  std::vector<UnrolledSegment> road = {{current}};
  std::set<SegmentKey> listed = {current->key};
  const auto list = [&](const std::shared_ptr<const SegmentLayer>& layer, double offset_m,
                        RoadSide side, int junctions, bool is_main_way) {
    const UnrolledSegment found = {layer, offset_m, side, junctions, is_main_way};
    if (!found.extent().meets(range) || !listed.insert(layer->key).second) return;
    road.push_back(found);
  };
  std::size_t listed_from = 0;  // breadth first: the road grows while it is gone through
  while (listed_from < road.size()) {
    const UnrolledSegment from = road[listed_from++];
    for (const Successor& successor : from.layer->successors) {
      const auto key = key_of(successor, *from.layer, held);
      const auto layer = key ? layer_held(held, *key) : nullptr;
      if (!layer) continue;
      list(layer, from.offset_m + begin_of(*layer, *from.layer), side_after(from.side, true),
           from.junctions + 1, from.is_main_way && is_first_successor(*from.layer, *key, held));
    }
    for (const auto& [key, segment] : held.segments) {
      if (!segment->layer || !leads_to(*segment->layer, from.layer->key, held)) continue;
      list(segment->layer, from.offset_m - begin_of(*from.layer, *segment->layer),
           side_after(from.side, false), from.junctions + 1,
           from.is_main_way && is_first_successor(*segment->layer, from.layer->key, held));
    }
  }
  return road;
}

}  // namespace milepost
