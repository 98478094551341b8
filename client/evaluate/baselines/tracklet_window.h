// The tracklets around the vehicle: decoded tiles of one layer of one segment, with an index.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "client/localize/tile_window.h"
#include "schema/feature/descriptor_index.h"
#include "schema/tile/layer_items.h"
#include "schema/tile/observation.h"

namespace milepost {

struct WindowSettings {
  WindowReach reach;
  IndexSettings index;
};

// Not safe to use from several threads at once.
class TrackletWindow {
 public:
  TrackletWindow(SegmentKey segment, const WindowSettings& settings);

  // Loads every held tracklet whose arc length range meets `range` and discards others.
  Covered cover(const HeldMap& held, const AlongRange& range);

  // Valid until the next cover().
  const std::vector<Tracklet>& tracklets() const { return tracklets_; }
  const Track& track(std::size_t tracklet) const { return tracks_[tracklet]; }  // may be empty
  ScaleModel model() const { return model_; }
  // Over the tracklets' descriptors, or over those of all their observations if the layer stores
  // them.
  const DescriptorIndex& index() const { return *index_; }
  // The tracklet that a descriptor of the index belongs to.
  std::size_t tracklet_of(std::size_t descriptor) const { return tracklet_of_[descriptor]; }

 private:
  void rebuild();
  void add_descriptors(std::size_t tracklet);

  TileWindow<ObservationTile> tiles_;
  WindowSettings settings_;
  ScaleModel model_ = ScaleModel::inverse_scale;
  std::vector<Tracklet> tracklets_;
  std::vector<Track> tracks_;            // one per tracklet
  std::vector<Descriptor> descriptors_;  // of the index
  std::vector<std::size_t> tracklet_of_;
  std::unique_ptr<DescriptorIndex> index_;
};

}  // namespace milepost
