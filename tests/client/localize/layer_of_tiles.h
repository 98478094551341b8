// A map source of one layer whose tiles lie in memory.
#pragma once

#include <vector>

#include "client/fetch/map_source.h"

namespace milepost::testing {

class LayerOfTiles : public MapSource {
 public:
  struct Tile {
    AlongRange along;
    Bytes frame;
  };

  explicit LayerOfTiles(std::vector<Tile> tiles) : tiles_(std::move(tiles)) {}

  Result<std::vector<TileFrame>> tiles(const MapVersion& /*version*/,
                                       const std::string& /*segment*/, const std::string& /*layer*/,
                                       const AlongRange& range) override {
    std::vector<TileFrame> met;
    for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
      if (tiles_[i].along.meets(range)) met.push_back({i, tiles_[i].frame});
    }
    return met;
  }

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& /*position*/,
                                                   double /*radius_m*/) override {
    return absent();
  }
  Result<std::vector<MapVersion>> maps() override { return absent(); }
  Result<MapDescription> describe(const MapVersion& /*version*/) override { return absent(); }
  Result<SegmentDescription> segment(const MapVersion& /*version*/,
                                     const std::string& /*segment*/) override {
    return absent();
  }
  Result<std::vector<CellFrame>> cells(const MapVersion& /*version*/, const std::string& /*layer*/,
                                       const Bounds& /*box*/) override {
    return absent();
  }
  Result<std::uint64_t> layer_bytes(const MapVersion& /*version*/, const std::string& /*segment*/,
                                    const std::string& /*layer*/) override {
    return absent();
  }
  SourceCounters counters() const override { return {}; }

 private:
  static Error absent() { return {ErrorCode::not_found, "layer of tiles", "only tiles", ""}; }

  std::vector<Tile> tiles_;
};

}  // namespace milepost::testing
