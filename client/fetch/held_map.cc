#include "client/fetch/held_map.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "schema/tile/codec.h"

namespace milepost {
namespace {

ObservationTile without_observations(const TrackletTile& tile) {
  ObservationTile unobserved{tile.segment, tile.index, tile.model, {}};
  unobserved.tracklets.reserve(tile.tracklets.size());
  for (const Tracklet& tracklet : tile.tracklets) unobserved.tracklets.push_back({tracklet, {}});
  return unobserved;
}

template <class Tile>
Result<DecodedTile> as_decoded(Result<Tile> tile) {
  if (!tile) return tile.error();
  return DecodedTile(std::move(*tile));
}

}  // namespace

Result<DecodedTile> decode_tile_of(LayerItems items, ByteView encoded) {
  switch (items) {
    case LayerItems::landmarks:
      return as_decoded(decode_landmarks(encoded));
    case LayerItems::observations:
      return as_decoded(decode_observations(encoded));
    case LayerItems::frames:
      return as_decoded(decode_frames(encoded));
    case LayerItems::tracklets:
      break;
  }
  const Result<TrackletTile> tile = decode_tile(encoded);
  if (!tile) return tile.error();
  return DecodedTile(without_observations(*tile));
}

const HeldSegment* HeldMap::find(const SegmentKey& key) const {
  const auto found = segments.find(key);
  return found == segments.end() ? nullptr : found->second.get();
}

std::optional<std::vector<NearbySegment>> HeldMap::segments_near(const Surroundings& asked) const {
  const bool is_known =
      known_around.radius_m >= 0 &&
      geodesic_distance_m(known_around.position, asked.position) + asked.radius_m <=
          known_around.radius_m;
  if (!is_known) return std::nullopt;
  const double moved_m = geodesic_distance_m(known_around.position, asked.position);
  std::vector<NearbySegment> near;
  for (NearbySegment segment : around) {
    const HeldSegment* held = find({segment.version, segment.segment});
    if (held != nullptr && held->layer != nullptr) {
      const LineProjection nearest = held->layer->line.project(asked.position);
      segment.along_m = nearest.along_m;
      segment.distance_m = nearest.distance_m;
    } else {  // a lower bound of the distance
      segment.distance_m = std::abs(segment.distance_m - moved_m);
    }
    if (segment.distance_m <= asked.radius_m) near.push_back(std::move(segment));
  }
  std::ranges::sort(near, {}, [](const NearbySegment& segment) {
    return std::tie(segment.distance_m, segment.version.map, segment.segment);
  });
  return near;
}

}  // namespace milepost
