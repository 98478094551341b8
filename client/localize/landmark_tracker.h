// Tracks the camera's pose from frame to frame by landmarks.
#pragma once

#include <optional>

#include "client/localize/landmark_matching.h"
#include "client/localize/landmark_method.h"
#include "client/localize/landmark_support.h"
#include "client/localize/landmark_window.h"
#include "client/localize/pose_solver.h"
#include "client/localize/segment_tracker.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// What a relocalizer and its trackers have in common.
struct LandmarkSearch {
  const SegmentLayer* layer = nullptr;
  Camera camera;
  LandmarkMethod method;
  int min_start_support = 0;  // inlier votes or matches
  std::function<void(const TrackletEstimate&)> on_estimate;

  const CompactFrame& compact(SharedFrame& frame) const {
    return frame.compact(layer->feature(), *layer->parameters().projection);
  }
};

class LandmarkTracker : public SegmentTracker {
 public:
  // REQUIRES: the objects that the search refers to outlive the tracker.
  LandmarkTracker(const LandmarkSearch& search, LandmarkWindow window)
      : search_(search),
        method_(search.method),
        line_(search.layer->line),
        window_(std::move(window)) {}

  // Initializes the belief near `along_m` from this frame.
  TrackingResult begin(SharedFrame& frame, double along_m,
                       const std::optional<LearnedCamera>& camera);

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

  const LandmarkSearch& search_;
  const LandmarkMethod& method_;
  const RouteLine& line_;
  LandmarkWindow window_;
  PoseBelief belief_;       // in the window's tangent frame
  double timestamp_s_ = 0;  // of the belief
  double last_along_m_ = 0;
  double missed_part_ = 0;             // of the predicted landmarks, in the last frame used
  double usual_log_bayes_factor_ = 0;  // moving average over the frames used
};

}  // namespace milepost
