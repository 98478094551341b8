// A snapshot of the map data in memory: decoded, immutable and shared.
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

// A decoded tile. Tracklets without observations are decoded as an ObservationTile with empty
// tracks.
using DecodedTile = std::variant<LandmarkTile, ObservationTile, ImageDescriptorTile>;

// Errors: corrupt (FORMAT.md).
Result<DecodedTile> decode_tile_of(LayerItems items, ByteView encoded);

struct HeldSegment {
  std::shared_ptr<const SegmentLayer> layer;  // null until its documents have arrived
  std::optional<Error> failure;               // why they have not
  std::map<std::uint32_t, std::shared_ptr<const DecodedTile>> tiles;
  std::map<std::uint32_t, Error> missing;  // tiles whose request failed, and why
};

// Immutable once published. Safe to read from several threads at once.
class HeldMap {
 public:
  // Null if the segment is not wanted.
  const HeldSegment* find(const SegmentKey& key) const;

  // The segments that pass within a radius of a position, nearest first; none while the
  // surroundings are not known up to that radius.
  std::optional<std::vector<NearbySegment>> segments_near(const Surroundings& asked) const;

  std::map<SegmentKey, std::shared_ptr<const HeldSegment>> segments;
  // All segments within the known surroundings, as the source listed them.
  Surroundings known_around{{}, -1};
  std::vector<NearbySegment> around;
  std::optional<Error> around_failure;             // why they could not be updated
  std::map<std::string, MapVersion> current_maps;  // by name, of the catalog; those asked for
};

}  // namespace milepost
