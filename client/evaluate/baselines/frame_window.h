// The map's frames around the vehicle: decoded tiles of one layer of one segment.
#pragma once

#include <memory>
#include <vector>

#include "client/localize/tile_window.h"
#include "schema/feature/descriptor_index.h"
#include "schema/tile/database_frame.h"

namespace milepost {

// A frame of the map with an index over its features.
class IndexedFrame {
 public:
  IndexedFrame(const DatabaseFrame& frame, const IndexSettings& settings)
      : frame_(&frame), settings_(settings) {}

  const DatabaseFrame& frame() const { return *frame_; }
  // Built on first use: most held frames are never matched.
  const DescriptorIndex& index() const;

 private:
  const DatabaseFrame* frame_;
  IndexSettings settings_;
  mutable std::unique_ptr<DescriptorIndex> index_;
};

// Not safe to use from several threads at once.
class FrameWindow {
 public:
  FrameWindow(SegmentKey segment, const WindowReach& reach, const IndexSettings& index);

  // Loads every held frame in `range` and discards others.
  Covered cover(const HeldMap& held, const AlongRange& range);

  // By ascending arc length. Valid until the next cover().
  const std::vector<IndexedFrame>& frames() const { return frames_; }

 private:
  TileWindow<ImageDescriptorTile> tiles_;
  IndexSettings index_;
  std::vector<IndexedFrame> frames_;
};

}  // namespace milepost
