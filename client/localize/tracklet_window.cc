#include "client/localize/tracklet_window.h"

#include "schema/tile/codec.h"

namespace milepost {

TrackletWindow::TrackletWindow(std::shared_ptr<MapSource> source, MapVersion version,
                               std::string segment, std::string layer,
                               const WindowSettings& settings)
    : source_(std::move(source)),
      version_(std::move(version)),
      segment_(std::move(segment)),
      layer_(std::move(layer)),
      settings_(settings) {
  rebuild();
}

Status TrackletWindow::cover(const AlongRange& range) {
  const bool covered = covered_.from_m <= range.from_m && range.to_m <= covered_.to_m;
  if (covered) return ok_status();
  const AlongRange wanted = {range.from_m - settings_.behind_m, range.to_m + settings_.ahead_m};
  const Result<std::vector<TileFrame>> frames = source_->tiles(version_, segment_, layer_, wanted);
  if (!frames) return frames.error();

  std::map<std::uint32_t, TrackletTile> tiles;
  for (const TileFrame& frame : *frames) {
    if (auto held = tiles_.extract(frame.index)) {
      tiles.insert(std::move(held));
      continue;
    }
    Result<TrackletTile> tile = decode_tile(frame.frame);
    if (!tile) return tile.error();
    tiles.emplace(frame.index, std::move(*tile));
  }
  tiles_ = std::move(tiles);
  covered_ = wanted;
  rebuild();
  return ok_status();
}

void TrackletWindow::rebuild() {
  tracklets_.clear();
  descriptors_.clear();
  for (const auto& [index, tile] : tiles_) {
    model_ = tile.model;
    tracklets_.insert(tracklets_.end(), tile.tracklets.begin(), tile.tracklets.end());
  }
  descriptors_.reserve(tracklets_.size());
  for (const Tracklet& tracklet : tracklets_) descriptors_.push_back(tracklet.descriptor);
  index_ = std::make_unique<DescriptorIndex>(descriptors_, settings_.index);
}

}  // namespace milepost
