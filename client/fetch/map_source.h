// Where the client gets its map from: a server, with a cache in between, or a map file.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "client/fetch/retry.h"
#include "client/fetch/stopped.h"
#include "schema/base/bytes.h"
#include "schema/base/cell_grid.h"
#include "schema/base/range.h"
#include "schema/base/result.h"
#include "schema/feature/types.h"
#include "schema/geo/geodesy.h"
#include "schema/store/map_store.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {

// One build of one map. Everything read under it is immutable.
struct MapVersion {
  std::string map;
  std::string build;

  friend bool operator==(const MapVersion&, const MapVersion&) = default;
  friend bool operator<(const MapVersion& a, const MapVersion& b) {
    return std::tie(a.map, a.build) < std::tie(b.map, b.build);
  }
};

struct MapDescription {
  MapVersion version;
  // By name. Errors: corrupt, for those whose parameters this client does not understand; walls are
  // among them, of which it needs none.
  std::map<std::string, Result<LayerParameters>> layers = {};
  Result<FeatureParameters> feature = FeatureParameters();  // Errors: corrupt.
  Bounds bounds = {};                                       // of all segments' lines and all cells
};

// A segment that passes near a position.
struct NearbySegment {
  MapVersion version;
  std::string segment;
  double along_m = 0;     // of the nearest point of its line
  double distance_m = 0;  // from the position to that point
  double length_m = 0;
};

struct SegmentDescription {
  std::string id;
  double length_m = 0;
  std::vector<GeoPoint> vertices;
  std::vector<std::string> successors;
};

// A tile as it is stored: opaque here, decoded by schema/tile.
struct EncodedTile {
  std::uint32_t index = 0;
  Bytes bytes;
};

// The tile of one cell of the grid as it is stored, likewise.
struct EncodedCell {
  std::uint32_t cell = 0;
  Bytes bytes;
};

// Counts since the source was made: what a run cost in transport.
struct SourceCounters {
  std::uint64_t requests = 0;          // HTTP requests sent
  std::uint64_t bytes_received = 0;    // bodies, over HTTP
  std::uint64_t tiles_from_cache = 0;  // cells too
  std::uint64_t tiles_fetched = 0;     // cells too
  std::uint64_t cache_failures = 0;    // what the cache could not read or store (a full disk, say)
};

// Safe to use from several threads at once (the prefetcher uses it beside the localizer).
class MapSource {
 public:
  virtual ~MapSource() = default;

  // The segments within `radius_m` of a position over the whole catalog, nearest first.
  // An empty list is an answer. Errors: unavailable, corrupt, io.
  virtual Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                           double radius_m) = 0;
  // The current build of every map of the catalog, by name; those that the cache knows while there
  // is no server. Errors: unavailable, corrupt, io.
  virtual Result<std::vector<MapVersion>> maps() = 0;
  // Errors of all below: not_found, gone (the build was replaced), unavailable, corrupt, io.
  virtual Result<MapDescription> describe(const MapVersion& version) = 0;
  virtual Result<SegmentDescription> segment(const MapVersion& version,
                                             const std::string& segment) = 0;
  // The tiles of a layer with an item whose along range meets `range`, ascending by index.
  // Waits for what is not cached yet.
  virtual Result<std::vector<EncodedTile>> tiles(const MapVersion& version,
                                                 const std::string& segment,
                                                 const std::string& layer,
                                                 const AlongRange& range) = 0;
  // The cells of a layer that meet `box`, borders included, ascending. Waits for what is not cached
  // yet. Errors: also invalid_input (the box is none).
  virtual Result<std::vector<EncodedCell>> cells(const MapVersion& version,
                                                 const std::string& layer, const Bounds& box) = 0;
  // Bytes of all tiles of the layer on that segment: what a vehicle must hold for it.
  virtual Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                            const std::string& layer) = 0;
  virtual SourceCounters counters() const = 0;

  // For those who bring tiles into memory one by one (TileProvider):
  // Which tiles of a layer there are on a segment, ascending.
  virtual Result<std::vector<TileEntry>> tile_index(const MapVersion& version,
                                                    const std::string& segment,
                                                    const std::string& layer) = 0;
  // A tile that no server has to be asked for; nothing where it is not there.
  virtual Result<std::optional<Bytes>> stored_tile(const MapVersion& version,
                                                   const std::string& segment,
                                                   const std::string& layer,
                                                   const TileEntry& entry) = 0;
  // Asks once for tiles that stand side by side in the index; each is handed over as it arrives.
  // Ends well where some have, even if not all: the rest is asked for again.
  using TileSink = std::function<void(const EncodedTile& tile)>;
  virtual Attempt fetch_tiles(const MapVersion& version, const std::string& segment,
                              const std::string& layer, const std::vector<TileEntry>& tiles,
                              const TileSink& take) = 0;
  // The same source for a caller whose calls end with `cancelled` soon after `stopped` says so; and
  // who has a back-off of his own, if each call asks once.
  enum class Asking { once, as_often_as_set };
  virtual std::shared_ptr<MapSource> until(Stopped stopped, Asking asking) = 0;
};

}  // namespace milepost
