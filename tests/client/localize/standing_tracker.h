// A tracker that stays where it is.
#pragma once

#include <memory>
#include <utility>

#include "client/localize/segment_tracker.h"

namespace milepost::testing {

class Standing : public SegmentTracker {
 public:
  Standing(std::shared_ptr<const SegmentLayer> layer, TrackedPose at)
      : layer_(std::move(layer)), at_(std::move(at)) {}
  const std::shared_ptr<const SegmentLayer>& layer() const override { return layer_; }
  TrackedPose pose_at(double) const override { return at_; }
  AlongRange needed(double) const override { return {at_.along_m, at_.along_m}; }
  TrackingResult track(SharedFrame&) override { return {}; }
  TrackedPose pose() const override { return at_; }
  std::optional<LearnedCamera> learned_camera() const override {
    return LearnedCamera{{0.05, 0, 0}, Eigen::Matrix3d::Identity()};
  }

 private:
  std::shared_ptr<const SegmentLayer> layer_;
  TrackedPose at_;
};

}  // namespace milepost::testing
