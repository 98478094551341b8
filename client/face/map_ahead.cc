#include "client/face/map_ahead.h"

#include <algorithm>
#include <set>
#include <utility>

#include "client/face/conversions.h"
#include "client/fetch/documents.h"

namespace milepost::vehicle {
namespace {

// The contiguous length held from an arc length on, at most to the end of the segment.
double held_from_m(const HeldSegment& segment, double along_m) {
  const double end_m = segment.layer->line.length_m();
  double held_to_m = end_m;
  for (const TileEntry& entry : segment.layer->index) {
    const bool is_ahead = entry.along.to_m >= along_m;
    if (is_ahead && !segment.tiles.contains(entry.index)) {
      held_to_m = std::min(held_to_m, entry.along.from_m);
    }
  }
  return std::max(0.0, held_to_m - along_m);
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
  if (segment != nullptr && segment->layer) ahead.held_m = held_from_m(*segment, from->along_m);
  return ahead;
}

}  // namespace milepost::vehicle
