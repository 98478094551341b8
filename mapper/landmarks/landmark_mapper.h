// Maps landmarks from feature tracks and recorded poses, by sliding-window bundle adjustment.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/landmarks/adjustment.h"
#include "mapper/landmarks/triangulation.h"
#include "schema/drive/drive.h"
#include "schema/geo/geodesy.h"
#include "schema/geo/pinhole.h"
#include "schema/tile/observation.h"

namespace milepost {

struct LandmarkSettings {
  AdjustmentSettings adjustment;
  std::size_t window_frames = 80;   // adjusted together, in addition to ...
  std::size_t overlap_frames = 20;  // ... final frames before and provisional ones after
  double max_rms_px = 2;            // of a landmark's reprojection error, to reject moving objects
  double max_depth_sigma = 0.2;     // of a landmark's depth, relative to it
  double max_distance_m = 300;      // farther landmarks do not constrain the position
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

  // The landmarks whose poses have become final since the last call. `finished` finalizes all.
  std::vector<MappedLandmark> take_mapped(bool finished);
  // A lower bound of the begin of landmarks that are taken later. Infinity if no track waits.
  double oldest_waiting_along_m() const;

 private:
  struct RecordedPose {
    double along_m = 0;
    GeoPoint position;
    double heading_rad = 0;
    double pitch_rad = 0;
    double roll_rad = 0;
  };
  struct PendingTrack {
    FeatureTrack observations;  // frame indices relative to the first kept frame
    std::vector<double> scales_px;
    Descriptor descriptor{};
    AlongRange along;
    bool mapped = false;
  };

  void finalize(std::size_t frames, std::size_t final_after, std::vector<MappedLandmark>& mapped);
  void forget_final();

  Pinhole camera_;
  LandmarkSettings settings_;
  std::vector<RecordedPose> frames_;  // kept frames
  std::size_t final_ = 0;             // number of frames_ with final poses
  std::vector<PendingTrack> tracks_;  // in the order of their ends
};

}  // namespace milepost
