// Tracks the camera's pose from frame to frame by landmarks.
#pragma once

#include <optional>

#include "client/localize/landmark_matching.h"
#include "client/localize/landmark_method.h"
#include "client/localize/landmark_support.h"
#include "client/localize/landmark_window.h"
#include "client/localize/pose_solver.h"
#include "client/localize/segment_tracker.h"
#include "schema/geo/camera.h"

namespace milepost {

// What a relocalizer and its trackers have in common.
struct LandmarkSearch {
  Camera camera;
  LandmarkMethod method;
  int min_start_support = 0;  // inlier votes or matches
  WindowReach reach;
  std::function<void(const TrackletEstimate&)> on_estimate;
};

inline const CompactFrame& compact_frame(SharedFrame& frame, const SegmentLayer& layer) {
  return frame.compact(layer.feature(), *layer.parameters().projection);
}

// The road around a range of the current segment, as far as a window of landmarks reaches.
inline std::vector<UnrolledSegment> road_around(const HeldMap& held,
                                                const std::shared_ptr<const SegmentLayer>& current,
                                                const AlongRange& range, const WindowReach& reach) {
  return unrolled_road(held, current, reach.around(range));
}

class LandmarkTracker : public SegmentTracker {
 public:
  LandmarkTracker(std::shared_ptr<const LandmarkSearch> search,
                  std::shared_ptr<const SegmentLayer> layer, LandmarkWindow window)
      : search_(std::move(search)), layer_(std::move(layer)), window_(std::move(window)) {}

  // Initializes the belief near `along_m` from this frame.
  TrackingResult begin(SharedFrame& frame, double along_m,
                       const std::optional<LearnedCamera>& camera);

  const std::shared_ptr<const SegmentLayer>& layer() const override { return layer_; }
  void observe(const Odometry& odometry) override;
  TrackedPose pose_at(double timestamp_s) const override;
  AlongRange needed(double timestamp_s) const override;
  TrackingResult track(SharedFrame& frame) override;
  TrackedPose pose() const override;
  std::optional<LearnedCamera> learned_camera() const override;

 private:
  // A belief of the pose in Frenet coordinates.
  struct FrenetPosition {
    double along_m = 0;  // also beyond the ends of the line
    double lateral_m = 0;
    double along_sigma_m = 0;
    double lateral_sigma_m = 0;
  };

  const LandmarkMethod& method() const { return search_->method; }
  const RouteLine& line() const { return layer_->line; }
  double quantization_step() const { return layer_->parameters().projection->quantization_step(); }

  void follow_road(const HeldMap& held, const PoseBelief& belief);
  void move_to(const UnrolledSegment& segment);
  double mismatch_m(const UnrolledSegment& segment, const PoseBelief& belief, double along_m) const;
  Covered cover(const HeldMap& held, const AlongRange& region);
  std::optional<PoseEstimate> track_landmarks(const CompactFrame& frame, const PoseBelief& before,
                                              const AlongRange& region) const;
  std::optional<PoseEstimate> relocalize(const CompactFrame& frame, const PoseBelief& before,
                                         const AlongRange& region) const;
  LandmarkSupport support_of(const PoseEstimate& estimate, const CompactFrame& frame) const;
  double log_density_of_jump(const PoseBelief& before, const PoseBelief& found) const;
  PoseBelief first_belief(double along_m) const;
  PoseBelief widened(const PoseBelief& belief) const;
  PoseBelief predicted_to(double timestamp_s) const;
  GeoPoint position_of(const PoseBelief& belief) const;
  FrenetPosition frenet_of(const PoseBelief& belief) const;
  TrackedPose tracked_pose(const PoseBelief& belief) const;
  GeoCameraPose camera_pose_of(const PoseBelief& belief, double sigma_factor) const;
  AlongRange region_about(const PoseBelief& belief) const;
  void measure(const CompactFrame& frame, const PoseBelief& before, const AlongRange& region,
               TrackingResult& result);
  void accept(const PoseEstimate& estimate, const LandmarkSupport& support,
              const CompactFrame& frame, TrackingResult& result);
  void recenter_frame();
  void report_estimates(const PoseEstimate& estimate, const CompactFrame& frame) const;

  std::shared_ptr<const LandmarkSearch> search_;
  std::shared_ptr<const SegmentLayer> layer_;  // the current segment
  LandmarkWindow window_;
  AlongRange mapped_;       // the arc length over which the road is held, before and after, too
  PoseBelief belief_;       // in the window's tangent frame
  double timestamp_s_ = 0;  // of the belief
  double last_along_m_ = 0;
  double missed_part_ = 0;             // of the predicted landmarks, in the last frame used
  double usual_log_bayes_factor_ = 0;  // moving average over the frames used
};

}  // namespace milepost
