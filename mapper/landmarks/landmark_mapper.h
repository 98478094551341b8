// Maps landmarks from feature tracks and recorded poses, by sliding-window bundle adjustment.
#pragma once

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "mapper/landmarks/adjustment.h"
#include "mapper/landmarks/triangulation.h"
#include "mapper/landmarks/vehicles_ahead.h"
#include "schema/drive/drive.h"
#include "schema/geo/camera.h"
#include "schema/geo/geodesy.h"
#include "schema/tile/observation.h"

namespace milepost {

struct LandmarkSettings {
  AdjustmentSettings adjustment;
  std::size_t window_frames = 80;   // adjusted together, in addition to ...
  std::size_t overlap_frames = 20;  // ... final frames before and provisional ones after
  double max_rms_px = 2;            // of a landmark's reprojection error, to reject moving objects
  double max_depth_sigma = 0.2;     // of a landmark's depth, relative to it
  double max_distance_m = 300;      // farther landmarks do not constrain the position
  VehiclesAheadSettings vehicles_ahead;
};

// A landmark before selection and quantization.
struct MappedLandmark {
  Descriptor descriptor{};  // mean over the observations
  GeoPoint position;
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  // of the position: east, north, up
  double depth_m = 0;                                       // from its first observation
  double depth_sigma_m = 0;
  double size_m = 0;      // s * depth / f of its feature
  double size_sigma = 0;  // of ln(s * depth / f) over the observations
  AlongRange along;       // of its observations
  std::size_t observations = 0;
  std::size_t passes = 1;        // drives that saw it ...
  std::size_t passes_there = 1;  // ... of those that passed the segment
  double right_m =
      0;  // where it was mapped, in the middle of its range: right of the segment's line
};

// A frame with its pose, recorded at first, and what the images say of that.
struct AdjustedFrame {
  double along_m = 0;
  GeoPoint position;
  double heading_rad = 0;
  double pitch_rad = 0;
  double roll_rad = 0;
  ImageWitness witness;
};

// Not safe to use from several threads. Memory is bounded by the window, not by the drive.
class LandmarkMapper {
 public:
  LandmarkMapper(const Camera& camera, const LandmarkSettings& settings);

  // Adds the next frame's recorded pose. REQUIRES: `along_m` is greater than the one before.
  void add_frame(const Frame& frame, double along_m);
  // Adds tracks that have ended, of the frames so far. Observations in frames that are no longer
  // kept are ignored.
  void add_tracks(const std::vector<Track>& tracks);

  // The landmarks, by end of their range, of which all is known by now. `finished` finalizes all.
  std::vector<MappedLandmark> take_mapped(bool finished);

  // The frames whose poses have become final since the last call.
  std::vector<AdjustedFrame> take_adjusted() { return std::exchange(adjusted_, {}); }

 private:
  struct PendingTrack {
    FeatureTrack observations;  // frame indices relative to the first kept frame
    std::vector<double> scales_px;
    Descriptor descriptor{};
    AlongRange along;
    bool mapped = false;
  };

  struct Placed {
    MappedLandmark landmark;
    VehiclesAhead::Place seen;
  };

  void finalize(std::size_t frames, std::size_t final_after);
  std::vector<MappedLandmark> take_placed_before(double along_m);
  void forget_final();

  Pinhole camera_;
  LandmarkSettings settings_;
  std::vector<AdjustedFrame> frames_;  // kept frames; recorded poses beyond the final ones
  std::size_t final_ = 0;              // number of frames_ with final poses
  std::vector<PendingTrack> tracks_;   // in the order of their ends
  std::vector<AdjustedFrame> adjusted_;
  VehiclesAhead vehicles_ahead_;
  std::deque<Placed> placed_;  // until it is known what is seen of vehicles after them
};

}  // namespace milepost
