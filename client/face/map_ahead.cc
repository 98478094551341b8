#include "client/face/map_ahead.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "client/face/conversions.h"
#include "client/fetch/documents.h"
#include "client/localize/unrolled_road.h"

namespace milepost::vehicle {
namespace {

constexpr double kFarthestM = 10000;  // that is looked ahead

// Where the first tile from an arc length on that is not held begins; infinite if all are held.
double first_gap_m(const HeldSegment& segment, double along_m) {
  double gap_m = std::numeric_limits<double>::infinity();
  for (const TileEntry& entry : segment.layer->index) {
    const bool is_ahead = entry.along.to_m >= along_m;
    if (is_ahead && !segment.tiles.contains(entry.index))
      gap_m = std::min(gap_m, entry.along.from_m);
  }
  return gap_m;
}

using OffsetsAhead = std::map<SegmentKey, double>;  // of segments on the way ahead

// Whether a successor is not known, or not looked at from here on: a road that leads back to the
// vehicle, or that is reached over another one first.
bool has_unknown_successor(const UnrolledSegment& part, const OffsetsAhead& ahead,
                           const HeldMap& held) {
  return std::ranges::any_of(part.layer->successors, [&](const Successor& successor) {
    const auto key = key_of(successor, *part.layer, held);
    const auto known = key ? ahead.find(*key) : ahead.end();
    return known == ahead.end() || known->second > part.extent().to_m;
  });
}

// The contiguous length held from an arc length on, on every branch; at most to where the last one
// ends.
double held_from_m(const HeldSegment& segment, double along_m, const HeldMap& held) {
  double held_to_m = std::numeric_limits<double>::infinity();
  double end_m = along_m;
  auto road = unrolled_road(held, segment.layer, {along_m, along_m + kFarthestM});
  std::erase_if(road, [](const UnrolledSegment& part) {
    return part.side != RoadSide::current && part.side != RoadSide::ahead;
  });
  OffsetsAhead ahead;
  for (const UnrolledSegment& part : road) {
    if (part.side == RoadSide::ahead) ahead.emplace(part.layer->key, part.offset_m);
  }
  for (const UnrolledSegment& part : road) {
    const double from_m = std::max(0.0, along_m - part.offset_m);
    held_to_m =
        std::min(held_to_m, part.offset_m + first_gap_m(*held.find(part.layer->key), from_m));
    if (has_unknown_successor(part, ahead, held))
      held_to_m = std::min(held_to_m, part.extent().to_m);
    end_m = std::max(end_m, part.extent().to_m);
  }
  return std::max(0.0, std::min(held_to_m, end_m) - along_m);
}

MissingRange missing_range(const SegmentKey& key, const AlongRange& range,
                           const std::optional<milepost::Error>& why) {
  MissingRange missing{key.version.map, key.segment, range.from_m, range.to_m, {}};
  if (why) missing.why = error_of(*why);
  return missing;
}

void add_missing(const HeldMap& held, const Want& want, MapAhead& ahead) {
  const HeldSegment* segment = held.find(want.segment);
  if (segment == nullptr || !segment->layer) {
    ahead.missing.push_back(
        missing_range(want.segment, want.range, segment ? segment->failure : std::nullopt));
    return;
  }
  for (const TileEntry& entry : entries_meeting(segment->layer->index, want.range)) {
    if (segment->tiles.contains(entry.index)) continue;
    const auto why = segment->missing.find(entry.index);
    ahead.missing.push_back(
        missing_range(want.segment, entry.along,
                      why == segment->missing.end() ? std::nullopt : std::optional(why->second)));
  }
}

}  // namespace

MapAhead map_ahead_of(const HeldMap& held, const Wants& wants,
                      const std::optional<OnSegment>& from) {
  MapAhead ahead;
  const bool is_known = !wants.around || held.segments_near(*wants.around);
  if (!is_known && held.around_failure) ahead.failure = error_of(*held.around_failure);
  for (const Want& want : wants.tiles) add_missing(held, want, ahead);
  // Ranges wanted twice are listed once.
  const auto order = [](const MissingRange& range) {
    return std::tie(range.map, range.segment, range.from_m, range.to_m);
  };
  std::ranges::sort(ahead.missing, {}, order);
  const auto is_same = [&](const MissingRange& a, const MissingRange& b) {
    return order(a) == order(b);
  };
  ahead.missing.erase(std::unique(ahead.missing.begin(), ahead.missing.end(), is_same),
                      ahead.missing.end());
  const HeldSegment* segment = from ? held.find(from->key) : nullptr;
  if (segment != nullptr && segment->layer)
    ahead.held_m = held_from_m(*segment, from->along_m, held);
  return ahead;
}

}  // namespace milepost::vehicle
