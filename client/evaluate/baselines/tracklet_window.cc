#include "client/evaluate/baselines/tracklet_window.h"

#include "schema/tile/codec.h"

namespace milepost {
namespace {

// A tile of tracklets as one whose observations were not kept.
Result<ObservationTile> decode_tracklets(ByteView frame) {
  const Result<TrackletTile> tile = decode_tile(frame);
  if (!tile) return tile.error();
  ObservationTile unobserved{tile->segment, tile->index, tile->model, {}};
  unobserved.tracklets.reserve(tile->tracklets.size());
  for (const Tracklet& tracklet : tile->tracklets) unobserved.tracklets.push_back({tracklet, {}});
  return unobserved;
}

}  // namespace

TrackletWindow::TrackletWindow(LayerSource from, LayerItems items, const WindowSettings& settings)
    : tiles_(std::move(from), settings.reach,
             items == LayerItems::observations ? decode_observations : decode_tracklets),
      settings_(settings) {
  rebuild();
}

Status TrackletWindow::cover(const AlongRange& range) {
  const Result<bool> changed = tiles_.cover(range);
  if (!changed) return changed.error();
  if (*changed) rebuild();
  return ok_status();
}

void TrackletWindow::rebuild() {
  tracklets_.clear();
  tracks_.clear();
  descriptors_.clear();
  tracklet_of_.clear();
  for (const auto& [index, tile] : tiles_.tiles()) {
    model_ = tile.model;
    for (const ObservedTracklet& observed : tile.tracklets) {
      tracklets_.push_back(observed.tracklet);
      tracks_.push_back(observed.track);
      add_descriptors(tracklets_.size() - 1);
    }
  }
  index_ = std::make_unique<DescriptorIndex>(descriptors_, settings_.index);
}

void TrackletWindow::add_descriptors(std::size_t tracklet) {
  const Track& track = tracks_[tracklet];
  for (const Observation& observation : track) descriptors_.push_back(observation.descriptor);
  if (track.empty()) descriptors_.push_back(tracklets_[tracklet].descriptor);
  tracklet_of_.resize(descriptors_.size(), tracklet);
}

}  // namespace milepost
