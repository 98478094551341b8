#include "client/evaluate/baselines/frame_window.h"

namespace milepost {

const DescriptorIndex& IndexedFrame::index() const {
  if (!index_) index_ = std::make_unique<DescriptorIndex>(frame_->features.descriptors, settings_);
  return *index_;
}

FrameWindow::FrameWindow(SegmentKey segment, const WindowReach& reach, const IndexSettings& index)
    : tiles_(std::move(segment), reach), index_(index) {}

Covered FrameWindow::cover(const HeldMap& held, const AlongRange& range) {
  Covered covered = tiles_.cover(held, range);
  if (!covered.changed) return covered;
  frames_.clear();
  tiles_.for_each([this](const ImageDescriptorTile& tile) {
    for (const DatabaseFrame& frame : tile.frames) frames_.emplace_back(frame, index_);
  });
  return covered;
}

}  // namespace milepost
