// How one method finds the camera on one segment and follows it there.
#pragma once

#include <memory>
#include <optional>

#include "client/localize/estimate.h"
#include "client/localize/localizer.h"
#include "client/localize/segment_session.h"
#include "client/localize/tracker.h"

namespace milepost {

// Where a first look puts the camera.
struct Sighting {
  Measurement measurement;
  double merit = 0;   // of several sightings in one frame, the one of the greatest is believed
  AlongRange around;  // that was looked at
};

// What a frame said.
struct Followed {
  bool measured = false;  // its measurement was taken in; else the motion carries on
  int matches = 0;        // that agree with it
  std::optional<Error> failure =
      std::nullopt;  // of the source, where it kept the frame from being measured
};

// Not safe to use from several threads at once. Errors of all: those of MapSource::tiles, corrupt.
class Follower {
 public:
  virtual ~Follower() = default;

  // Looks for the camera in `around`; nothing where the frame is no evidence.
  virtual Result<std::optional<Sighting>> find(const QueryFrame& frame,
                                               const AlongRange& around) = 0;
  // Begins to follow from what find() saw in the same frame. The matches that agree.
  virtual Result<int> start(const QueryFrame& frame, const Sighting& sighting) = 0;

  // All below REQUIRE start().
  // Takes in what the wheels say, of now or since the last frame. Methods without a use for it, as
  // the papers', ignore it.
  virtual void observe(const Odometry& /*odometry*/) {}
  // Where the camera is expected at a time after the last frame's.
  virtual double expected_along_m(double timestamp_s) const = 0;
  // Follows to the next frame.
  virtual Followed follow(const QueryFrame& frame) = 0;
  virtual TrackedPosition position() const = 0;
};

// By tracklets: matches, their combination, a tracker.
std::unique_ptr<Follower> make_tracklet_follower(const SegmentSession& session,
                                                 const QueryCamera& camera,
                                                 const LocalizerSettings& settings,
                                                 const TrackletMethod& method);

// By landmarks: matches, a pose, and the belief that carries it on.
// REQUIRES: a layer of landmarks, so that the session has a codebook.
std::unique_ptr<Follower> make_landmark_follower(const SegmentSession& session,
                                                 const QueryCamera& camera,
                                                 const LocalizerSettings& settings,
                                                 const LandmarkMethod& method);

// By whole frames: dynamic time warping.
std::unique_ptr<Follower> make_warp_follower(const SegmentSession& session,
                                             const QueryCamera& camera,
                                             const LocalizerSettings& settings,
                                             const WarpMethod& method);

// As the method of the settings does. REQUIRES: `session` outlives the follower.
// Errors: corrupt (the layer holds other items than the method needs).
Result<std::unique_ptr<Follower>> make_follower(const SegmentSession& session,
                                                const QueryCamera& camera,
                                                const LocalizerSettings& settings);

}  // namespace milepost
