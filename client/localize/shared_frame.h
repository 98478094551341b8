// One frame as shared by all trackers of a localizer, so that costly results are computed once.
#pragma once

#include <map>
#include <memory>

#include "client/fetch/held_map.h"
#include "client/localize/landmark_matching.h"
#include "client/localize/query.h"

namespace milepost {

// Not safe to use from several threads at once. REQUIRES: the frame, the held map and every
// codebook passed outlive it.
class SharedFrame {
 public:
  SharedFrame(const QueryFrame& frame, const HeldMap& held) : frame_(frame), held_(held) {}

  double timestamp_s() const { return frame_.timestamp_s; }
  const QueryFrame& frame() const { return frame_; }
  const HeldMap& held() const { return held_; }  // the map data held when the frame was taken

  const FeatureSet& features(const FeatureParameters& parameters) const {
    return frame_.features(parameters);
  }

  // The features with descriptors compacted by a map's codebook (a PCA projection with a
  // quantization step).
  const CompactFrame& compact(const FeatureParameters& parameters,
                              const PcaProjection& projection) {
    std::unique_ptr<CompactFrame>& made = compact_[&projection];
    if (!made) made = std::make_unique<CompactFrame>(features(parameters), projection);
    return *made;
  }

 private:
  const QueryFrame& frame_;
  const HeldMap& held_;
  std::map<const PcaProjection*, std::unique_ptr<CompactFrame>> compact_;
};

}  // namespace milepost
