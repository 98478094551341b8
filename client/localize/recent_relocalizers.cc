#include "client/localize/recent_relocalizers.h"

#include <algorithm>

namespace milepost {

Result<Relocalizer*> RecentRelocalizers::on(const std::shared_ptr<const SegmentLayer>& layer) {
  constexpr std::size_t kKept = 8;
  const auto known = std::ranges::find(segments_, layer, &OpenSegment::layer);
  if (known != segments_.end()) {
    std::rotate(known, known + 1, segments_.end());
    return segments_.back().relocalizer.get();
  }
  Result<std::unique_ptr<Relocalizer>> relocalizer =
      method_.make_relocalizer(layer, camera_, settings_);
  if (!relocalizer) return relocalizer.error();
  if (segments_.size() >= kKept) segments_.erase(segments_.begin());
  segments_.push_back({layer, std::move(*relocalizer)});
  return segments_.back().relocalizer.get();
}

}  // namespace milepost
