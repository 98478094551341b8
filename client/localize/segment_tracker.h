// The interfaces of a method's relocalizer and tracker.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "client/fetch/segment_layer.h"
#include "client/localize/shared_frame.h"
#include "client/localize/tracked_pose.h"
#include "schema/geo/odometry.h"

namespace milepost {

// The result of tracking one frame.
struct TrackingResult {
  bool measured = false;      // the belief was updated by a measurement, not only propagated
  int matches = 0;            // inliers
  bool contradicted = false;  // the frame shows enough, but not what was predicted
  // Log Bayes factor of the frame for "the camera is where it is tracked" against "elsewhere"; 0
  // without a measurement.
  double log_bayes_factor = 0;
  // Why tiles are missing that the frame needs.
  std::optional<Error> failure = std::nullopt;
};

// The calibration error of the camera, estimated online: the logarithm of the true over the given
// focal length, and the shift of the principal point in focal lengths.
struct LearnedCamera {
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;
};

// A belief of the camera's position on the road. Not safe to use from several threads at once.
class SegmentTracker {
 public:
  virtual ~SegmentTracker() = default;

  // The segment that the position is on. Methods that know the camera's pose follow the road
  // through junctions: it changes in track().
  virtual const std::shared_ptr<const SegmentLayer>& layer() const = 0;
  // For methods that know the arc length only: the same belief, as if the vehicle had continued on
  // a successor, which begins at `begin_m` of this segment. Null for methods that follow the road
  // by themselves.
  virtual std::unique_ptr<SegmentTracker> continued_on(
      const std::shared_ptr<const SegmentLayer>& /*successor*/, double /*begin_m*/) const {
    return nullptr;
  }

  // Updates the belief with an odometry reading at its time, not before the last frame. Methods
  // that do not use odometry, like those of the papers, ignore it.
  virtual void observe(const Odometry& /*odometry*/) {}
  // The predicted pose at a time after the last frame.
  virtual TrackedPose pose_at(double timestamp_s) const = 0;
  // The range of the segment that track() needs at that time.
  virtual AlongRange needed(double timestamp_s) const = 0;
  // Tracks to the next frame. A measurement that contradicts the belief is not used.
  virtual TrackingResult track(SharedFrame& frame) = 0;
  virtual TrackedPose pose() const = 0;
  // None for methods that do not estimate it.
  virtual std::optional<LearnedCamera> learned_camera() const { return std::nullopt; }
};

// A candidate pose, as a tracker initialized there.
struct RelocalizationCandidate {
  std::unique_ptr<SegmentTracker> tracker;
  int matches = 0;  // inliers
  double log_bayes_factor = 0;
};

// The result of a relocalization with the tiles held.
struct Relocalization {
  std::vector<RelocalizationCandidate> candidates;  // the most likely first
  std::optional<Error> failure = std::nullopt;      // why tiles are missing
};

// Relocalizes the camera on one segment. Not safe to use from several threads at once.
class Relocalizer {
 public:
  virtual ~Relocalizer() = default;

  // The poses in the range `around` from which this frame may have been taken, with an estimated
  // calibration or, for none, the given one.
  virtual Relocalization relocalize(SharedFrame& frame, const AlongRange& around,
                                    const std::optional<LearnedCamera>& camera) = 0;
};

// The error, corrupt, for a layer whose items a method cannot use.
Error unusable_items(const SegmentLayer& layer);

}  // namespace milepost
