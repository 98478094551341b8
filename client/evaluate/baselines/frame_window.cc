#include "client/evaluate/baselines/frame_window.h"

#include "schema/tile/codec.h"

namespace milepost {

const DescriptorIndex& IndexedFrame::index() const {
  if (!index_) index_ = std::make_unique<DescriptorIndex>(frame_->features.descriptors, settings_);
  return *index_;
}

FrameWindow::FrameWindow(LayerSource from, const WindowReach& reach, const IndexSettings& index)
    : tiles_(std::move(from), reach, decode_frames), index_(index) {}

Status FrameWindow::cover(const AlongRange& range) {
  const Result<bool> changed = tiles_.cover(range);
  if (!changed) return changed.error();
  if (!*changed) return ok_status();
  frames_.clear();
  for (const auto& [index, tile] : tiles_.tiles()) {
    for (const DatabaseFrame& frame : tile.frames) frames_.emplace_back(frame, index_);
  }
  return ok_status();
}

}  // namespace milepost
