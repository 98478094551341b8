// One frame as all followers of a localizer share it: what is costly is made once.
#pragma once

#include <map>
#include <memory>

#include "client/fetch/held_map.h"
#include "client/localize/landmark_matching.h"
#include "client/localize/query.h"

namespace milepost {

// Not safe to use from several threads at once. REQUIRES: the frame, what is held and every
// codebook given outlive it.
class SeenFrame {
 public:
  SeenFrame(const QueryFrame& frame, const HeldMap& held) : frame_(frame), held_(held) {}

  double timestamp_s() const { return frame_.timestamp_s; }
  const QueryFrame& frame() const { return frame_; }
  const HeldMap& held() const { return held_; }  // of the map, when the frame was taken

  const FeatureSet& features(const FeatureParameters& parameters) const {
    return frame_.features(parameters);
  }

  // The features with descriptors of a map's codebook.
  const CompactFrame& compact(const FeatureParameters& parameters, const Codebook& codebook) {
    std::unique_ptr<CompactFrame>& made = compact_[&codebook];
    if (!made) made = std::make_unique<CompactFrame>(features(parameters), codebook);
    return *made;
  }

 private:
  const QueryFrame& frame_;
  const HeldMap& held_;
  std::map<const Codebook*, std::unique_ptr<CompactFrame>> compact_;
};

}  // namespace milepost
