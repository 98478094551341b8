#include "client/evaluate/baselines/tracklet_window.h"

namespace milepost {

TrackletWindow::TrackletWindow(SegmentKey segment, const WindowSettings& settings)
    : tiles_(std::move(segment), settings.reach), settings_(settings) {
  rebuild();
}

Covered TrackletWindow::cover(const HeldMap& held, const AlongRange& range) {
  Covered covered = tiles_.cover(held, range);
  if (covered.changed) rebuild();
  return covered;
}

void TrackletWindow::rebuild() {
  tracklets_.clear();
  tracks_.clear();
  descriptors_.clear();
  tracklet_of_.clear();
  tiles_.for_each([this](const ObservationTile& tile) {
    model_ = tile.model;
    for (const ObservedTracklet& observed : tile.tracklets) {
      tracklets_.push_back(observed.tracklet);
      tracks_.push_back(observed.track);
      add_descriptors(tracklets_.size() - 1);
    }
  });
  index_ = std::make_unique<DescriptorIndex>(descriptors_, settings_.index);
}

void TrackletWindow::add_descriptors(std::size_t tracklet) {
  const Track& track = tracks_[tracklet];
  for (const Observation& observation : track) descriptors_.push_back(observation.descriptor);
  if (track.empty()) descriptors_.push_back(tracklets_[tracklet].descriptor);
  tracklet_of_.resize(descriptors_.size(), tracklet);
}

}  // namespace milepost
