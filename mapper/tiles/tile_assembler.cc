#include "mapper/tiles/tile_assembler.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace milepost {

TileAssembler::TileAssembler(std::string segment, ScaleModel model, double tile_length_m)
    : segment_(std::move(segment)), model_(model), tile_length_m_(tile_length_m) {}

void TileAssembler::add(const Tracklet& tracklet) {
  const auto index = static_cast<std::uint32_t>(tracklet.along.from_m / tile_length_m_);
  TrackletTile& tile = tiles_[index];
  tile.tracklets.push_back(tracklet);
}

std::vector<TrackletTile> TileAssembler::take_complete(double along_m) {
  std::vector<TrackletTile> complete;
  while (!tiles_.empty() && (tiles_.begin()->first + 1) * tile_length_m_ <= along_m) {
    auto taken = tiles_.extract(tiles_.begin());
    TrackletTile& tile = taken.mapped();
    tile.segment = segment_;
    tile.index = taken.key();
    tile.model = model_;
    std::stable_sort(
        tile.tracklets.begin(), tile.tracklets.end(),
        [](const Tracklet& a, const Tracklet& b) { return a.along.from_m < b.along.from_m; });
    complete.push_back(std::move(tile));
  }
  return complete;
}

std::vector<TrackletTile> TileAssembler::take_all() {
  return take_complete(std::numeric_limits<double>::infinity());
}

}  // namespace milepost
