// The interface of the client's map sources: a tile server with a cache, or a map file.
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
#include "schema/document/stored_map.h"
#include "schema/feature/types.h"
#include "schema/geo/datum.h"
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
  // By name. Errors: corrupt, for layers whose parameters this client does not support; these
  // include the layers of walls, whose parameters it does not need.
  std::map<std::string, Result<LayerParameters>> layers = {};
  Result<FeatureParameters> feature = FeatureParameters();  // Errors: corrupt.
  Bounds bounds = {};                                       // around all segments and cells
  Datum datum = {};                                         // of all positions
};

// A segment that passes near a position. No build covers what a server lists here, nor its catalog:
// it says what to look at, never where the vehicle is.
struct NearbySegment {
  MapVersion version;
  std::string segment;
  double along_m = 0;     // arc length of the nearest point of its line
  double distance_m = 0;  // from the position to that point
  double length_m = 0;
};

struct SegmentDescription {
  std::string id;
  double length_m = 0;
  std::vector<GeoPoint> vertices;
  std::vector<Successor> successors;  // each with the name of its map, also of this one
  std::vector<StoredPass> passes = {};
  PositionError position_error = {};
};

// A tile as stored: opaque here, decoded by schema/tile.
struct EncodedTile {
  std::uint32_t index = 0;
  Bytes bytes;
};

// The tile of one cell of the grid, likewise.
struct EncodedCell {
  std::uint32_t cell = 0;
  Bytes bytes;
};

// Transport counters since the source was created.
struct SourceCounters {
  std::uint64_t requests = 0;          // HTTP requests sent
  std::uint64_t bytes_received = 0;    // of HTTP response bodies
  std::uint64_t tiles_from_cache = 0;  // including cells
  std::uint64_t tiles_fetched = 0;     // including cells
  std::uint64_t cache_failures = 0;    // what the cache could not read or store (a full disk, say)
};

// Documents and tiles of a build are checked against its digest before they are returned or stored,
// wherever they come from. Damaged ones are requested again, past every cache, and then are
// corrupt. Safe to use from several threads at once (the prefetcher uses it concurrently with the
// localizer).
class MapSource {
 public:
  virtual ~MapSource() = default;

  // The segments of all maps within `radius_m` of a position, nearest first; may be empty. Errors:
  // unavailable, corrupt, io.
  virtual Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                           double radius_m) = 0;
  // The current build of every map of the catalog, ordered by name; without a server those known to
  // the cache. Errors: unavailable, corrupt, io.
  virtual Result<std::vector<MapVersion>> maps() = 0;
  // Errors of all below: not_found, gone (the build was replaced), unavailable, corrupt, io.
  virtual Result<MapDescription> describe(const MapVersion& version) = 0;
  virtual Result<SegmentDescription> segment(const MapVersion& version,
                                             const std::string& segment) = 0;
  // The tiles of a layer with an item whose arc length range meets `range`, ascending by index.
  // Blocks until tiles that are not cached are fetched.
  virtual Result<std::vector<EncodedTile>> tiles(const MapVersion& version,
                                                 const std::string& segment,
                                                 const std::string& layer,
                                                 const AlongRange& range) = 0;
  // The cells of a layer that meet `box`, borders included, ascending. Blocks until cells that are
  // not cached are fetched. Errors: also invalid_input (an invalid box).
  virtual Result<std::vector<EncodedCell>> cells(const MapVersion& version,
                                                 const std::string& layer, const Bounds& box) = 0;
  // Total bytes of the layer's tiles on that segment: the memory that a vehicle needs for it.
  virtual Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                            const std::string& layer) = 0;
  virtual SourceCounters counters() const = 0;

  // For callers that load tiles one by one (TileProvider): The tiles of a layer on a segment,
  // ascending.
  virtual Result<std::vector<TileEntry>> tile_index(const MapVersion& version,
                                                    const std::string& segment,
                                                    const std::string& layer) = 0;
  // A tile that is available without a server; none if it is not.
  virtual Result<std::optional<Bytes>> stored_tile(const MapVersion& version,
                                                   const std::string& segment,
                                                   const std::string& layer,
                                                   const TileEntry& entry) = 0;
  // Sends one request for tiles that are adjacent in the index; each is passed to the sink as it
  // arrives. Succeeds if some arrive, even if not all: request the rest again.
  using TileSink = std::function<void(const EncodedTile& tile)>;
  virtual Attempt fetch_tiles(const MapVersion& version, const std::string& segment,
                              const std::string& layer, const std::vector<TileEntry>& tiles,
                              const TileSink& take) = 0;
  // The same source for another caller, whose calls end with `cancelled` soon after `stopped`
  // returns true. With Asking::once each call sends one request, for callers with a backoff of
  // their own.
  enum class Asking { once, as_often_as_set };
  virtual std::shared_ptr<MapSource> until(Stopped stopped, Asking asking) = 0;
};

}  // namespace milepost
