// One belief of the camera's pose, carried from frame to frame by landmarks.
#pragma once

#include <optional>

#include "client/localize/follower.h"
#include "client/localize/landmark_matching.h"
#include "client/localize/landmark_method.h"
#include "client/localize/landmark_window.h"
#include "client/localize/place_evidence.h"
#include "client/localize/pose_solver.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// What a scout and its followers have in common.
struct LandmarkSearch {
  const SegmentLayer* layer = nullptr;
  Camera camera;
  LandmarkMethod method;
  int min_start_support = 0;  // votes or matches that agree
  std::function<void(const TrackletEstimate&)> on_estimate;

  const CompactFrame& compact(SeenFrame& frame) const {
    return frame.compact(layer->feature(), *layer->parameters().codebook);
  }
};

class LandmarkFollower : public Follower {
 public:
  // REQUIRES: what the search refers to outlives the follower.
  LandmarkFollower(const LandmarkSearch& search, LandmarkWindow window)
      : search_(search),
        method_(search.method),
        line_(search.layer->line),
        window_(std::move(window)) {}

  // The belief of a first look that puts the camera near `along_m`, by this frame.
  Followed begin(SeenFrame& frame, double along_m, const std::optional<LearnedCamera>& camera);

  void observe(const Odometry& odometry) override;
  TrackedPosition position_at(double timestamp_s) const override;
  AlongRange needed(double timestamp_s) const override;
  Followed follow(SeenFrame& frame) override;
  TrackedPosition position() const override;
  std::optional<LearnedCamera> learned_camera() const override;

 private:
  // A belief about the pose as one about along and across the line.
  struct Placed {
    double along_m = 0;  // beyond the line's ends, too
    double lateral_m = 0;
    double along_sigma_m = 0;
    double lateral_sigma_m = 0;
  };

  std::optional<PoseEstimate> expected_to_be(const CompactFrame& frame, const PoseBelief& before,
                                             const AlongRange& region) const;
  std::optional<PoseEstimate> searched(const CompactFrame& frame, const PoseBelief& before,
                                       const AlongRange& region) const;
  PlaceSupport support_of(const PoseEstimate& estimate, const CompactFrame& frame) const;
  double log_density_of_leap(const PoseBelief& before, const PoseBelief& found) const;
  PoseBelief first_belief(double along_m) const;
  PoseBelief widened(const PoseBelief& belief) const;
  PoseBelief expected(double timestamp_s) const;
  GeoPoint position_of(const PoseBelief& belief) const;
  Placed placed(const PoseBelief& belief) const;
  TrackedPosition tracked(const PoseBelief& belief) const;
  CameraPlacement camera_of(const PoseBelief& belief, double sigma_factor) const;
  AlongRange region_about(const PoseBelief& belief) const;
  void measure(const CompactFrame& frame, const PoseBelief& before, const AlongRange& region,
               Followed& followed);
  void take(const PoseEstimate& estimate, const PlaceSupport& support, const CompactFrame& frame,
            Followed& followed);
  void lay_origin_near();
  void tell(const PoseEstimate& estimate, const CompactFrame& frame) const;

  const LandmarkSearch& search_;
  const LandmarkMethod& method_;
  const RouteLine& line_;
  LandmarkWindow window_;
  PoseBelief belief_;       // in the window's frame
  double timestamp_s_ = 0;  // of the belief
  double last_along_m_ = 0;
  double missed_part_ = 0;             // of the landmarks expected in the frame taken in last
  double usual_log_bayes_factor_ = 0;  // of the frames taken in of late
};

}  // namespace milepost
