// A map source with tiles in memory, which can be made to fail like a server.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "client/fetch/map_source.h"

namespace milepost::testing {

// One map with one layer. Every tile has to be fetched, unless it is stored. All members are safe
// to call from any thread.
class MemorySource : public MapSource, public std::enable_shared_from_this<MemorySource> {
 public:
  struct Tile {
    AlongRange along;
    Bytes bytes;
  };

  MemorySource(MapVersion version, std::string layer, nlohmann::json layer_parameters);

  void add(const SegmentDescription& segment, std::vector<Tile> tiles);
  // Replaces the current build.
  void build_anew(const std::string& build);
  // Makes tiles unavailable, or available again.
  void be_unavailable(bool unavailable = true) { is_unavailable_ = unavailable; }
  // Makes requests for this tile fail.
  void refuse_tile(std::uint32_t index);
  // Stores the tiles in the cache.
  void store_tiles() { is_stored_ = true; }
  // Makes calls that fetch block until they are released or stopped.
  void block(bool blocked = true) { is_blocked_ = blocked; }

  // The threads that have called, and the numbers of tile and document requests.
  std::set<std::thread::id> callers() const;
  int tile_requests() const { return tile_requests_; }
  int document_requests() const { return document_requests_; }
  int near_requests() const { return near_requests_; }

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override;
  Result<std::vector<MapVersion>> maps() override;
  Result<MapDescription> describe(const MapVersion& version) override;
  Result<SegmentDescription> segment(const MapVersion& version,
                                     const std::string& segment) override;
  Result<std::vector<EncodedTile>> tiles(const MapVersion& version, const std::string& segment,
                                         const std::string& layer,
                                         const AlongRange& range) override;
  Result<std::vector<EncodedCell>> cells(const MapVersion& version, const std::string& layer,
                                         const Bounds& box) override;
  Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                    const std::string& layer) override;
  SourceCounters counters() const override { return {}; }
  Result<std::vector<TileEntry>> tile_index(const MapVersion& version, const std::string& segment,
                                            const std::string& layer) override;
  Result<std::optional<Bytes>> stored_tile(const MapVersion& version, const std::string& segment,
                                           const std::string& layer,
                                           const TileEntry& entry) override;
  Attempt fetch_tiles(const MapVersion& version, const std::string& segment,
                      const std::string& layer, const std::vector<TileEntry>& tiles,
                      const TileSink& take) override;
  std::shared_ptr<MapSource> until(Stopped stopped, Asking asking) override;

 private:
  struct Road {
    SegmentDescription description;
    std::vector<Tile> tiles;
  };

  void note_caller();
  void wait_while_blocked();

  const std::string layer_;
  const nlohmann::json layer_parameters_;
  mutable std::mutex mutex_;  // guards all below except atomics
  MapVersion version_;
  std::map<std::string, Road> roads_;
  std::set<std::uint32_t> refused_;
  std::set<std::thread::id> callers_;
  std::vector<Stopped> stopped_;
  std::atomic<bool> is_unavailable_ = false;
  std::atomic<bool> is_stored_ = false;
  std::atomic<bool> is_blocked_ = false;
  std::atomic<int> tile_requests_ = 0;
  std::atomic<int> document_requests_ = 0;
  std::atomic<int> near_requests_ = 0;
};

}  // namespace milepost::testing
