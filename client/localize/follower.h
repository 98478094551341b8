// How one method finds the camera on one segment and follows it there.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "client/fetch/segment_layer.h"
#include "client/localize/seen_frame.h"
#include "client/localize/tracked_position.h"
#include "schema/geo/odometry.h"

namespace milepost {

// What a frame said.
struct Followed {
  bool measured = false;  // its measurement was taken in; else the motion carries on
  int matches = 0;        // that agree with it
  // Logarithm of how much more likely the frame is from where the camera is followed than from
  // elsewhere; 0 of a frame that says nothing.
  double log_bayes_factor = 0;
  // Why tiles are missing that the frame would have been compared with.
  std::optional<Error> failure = std::nullopt;
};

// What was learned on the way of how far the camera's calibration is off: the logarithm of the true
// focal length over the given one, and the shift of the principal point in focal lengths.
struct LearnedCamera {
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;
};

// One belief of where the camera is on a segment. Not safe to use from several threads at once.
class Follower {
 public:
  virtual ~Follower() = default;

  // Takes in what the wheels say, of now or since the last frame. Methods without a use for it, as
  // the papers', ignore it.
  virtual void observe(const Odometry& /*odometry*/) {}
  // Where the camera is expected at a time after the last frame's.
  virtual TrackedPosition position_at(double timestamp_s) const = 0;
  // What of the segment follow() looks at then.
  virtual AlongRange needed(double timestamp_s) const = 0;
  // Follows to the next frame. What speaks against the place is not taken in.
  virtual Followed follow(SeenFrame& frame) = 0;
  virtual TrackedPosition position() const = 0;
  // Nothing of methods that do not learn it.
  virtual std::optional<LearnedCamera> learned_camera() const { return std::nullopt; }
};

// Where a first look puts the camera, and what follows it from there.
struct Sighting {
  std::unique_ptr<Follower> follower;
  int matches = 0;  // that agree
  double log_bayes_factor = 0;
};

// What a look found, by the tiles that are held.
struct Looked {
  std::vector<Sighting> sightings;              // the most likely first
  std::optional<Error> failure = std::nullopt;  // why tiles are missing
};

// Looks for the camera on one segment. Not safe to use from several threads at once.
class Scout {
 public:
  virtual ~Scout() = default;

  // The places in `around` that this frame may have been taken from; by the camera as it is known
  // by now, or as it was given.
  virtual Looked look(SeenFrame& frame, const AlongRange& around,
                      const std::optional<LearnedCamera>& camera) = 0;
};

// The error where a method cannot use what a layer holds: corrupt.
Error unusable_items(const SegmentLayer& layer);

}  // namespace milepost
