// What of a map lies in memory at one instant: finished, immutable, and shared.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "client/fetch/segment_layer.h"
#include "client/fetch/wants.h"
#include "schema/tile/database_frame.h"
#include "schema/tile/landmark.h"
#include "schema/tile/observation.h"

namespace milepost {

// A decoded tile. Tracklets are observations that were not kept.
using DecodedTile = std::variant<LandmarkTile, ObservationTile, FrameTile>;

// Errors: corrupt (FORMAT.md).
Result<DecodedTile> decode_tile_of(LayerItems items, ByteView encoded);

struct HeldSegment {
  std::shared_ptr<const SegmentLayer> layer;  // empty until its documents are there
  std::optional<Error> failure;               // why they are not
  std::map<std::uint32_t, std::shared_ptr<const DecodedTile>> tiles;
  std::map<std::uint32_t, Error> missing;  // tiles asked for in vain, and why
};

// A value: nothing in it changes. Safe to read from several threads at once.
class HeldMap {
 public:
  // Null where the segment was never wanted.
  const HeldSegment* find(const SegmentKey& key) const;

  // The segments that pass within a distance of a position, nearest first; nothing while that is
  // not known as far as there.
  std::optional<std::vector<NearbySegment>> segments_near(const Surroundings& asked) const;

  std::map<SegmentKey, std::shared_ptr<const HeldSegment>> segments;
  // All segments within the surroundings, as they were told.
  Surroundings known_around{{}, -1};
  std::vector<NearbySegment> around;
  std::optional<Error> around_failure;  // why they are not known anew
};

}  // namespace milepost
