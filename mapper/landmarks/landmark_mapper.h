// From tracks and recorded poses to landmarks, window by window along the road.
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
  std::size_t window_frames = 80;   // adjusted together, beside ...
  std::size_t overlap_frames = 20;  // ... the settled ones before and the unsettled ones after
  double max_rms_px = 2;            // of a landmark's pixels about its images: what moves is no
                                    // landmark
  double max_depth_sigma = 0.2;     // of a landmark's depth, as part of it
  double max_distance_m = 300;      // farther landmarks say nothing of position
};

// A landmark before it is chosen and packed into a tile.
struct MappedLandmark {
  Descriptor descriptor{};  // mean over the observations
  GeoPoint position;
  double depth_m = 0;  // from its first observation
  double depth_sigma_m = 0;
  double size_m = 0;      // s * depth / f of its feature
  double size_sigma = 0;  // of ln(s * depth / f) over the observations
  AlongRange along;       // of its observations
  std::size_t observations = 0;
};

// Not safe to use from several threads. Memory is bounded by the window, not by the drive.
class LandmarkMapper {
 public:
  LandmarkMapper(const Camera& camera, const LandmarkSettings& settings);

  // Takes in the next frame's recorded pose, at `along_m`, which is greater than the one before.
  void add_frame(const Frame& frame, double along_m);
  // Takes in tracks that have ended, of the frames so far. Sights in frames that are kept no longer
  // are left out.
  void add_tracks(const std::vector<Track>& tracks);

  // The landmarks whose poses have settled since the last call. `finished` settles all.
  std::vector<MappedLandmark> take_mapped(bool finished);
  // No landmark that is taken later begins before. Infinity where no track waits.
  double oldest_waiting_along_m() const;

 private:
  struct RecordedPose {
    double along_m = 0;
    GeoPoint position;
    double heading_rad = 0;
    double pitch_rad = 0;
    double roll_rad = 0;
  };
  struct WaitingTrack {
    PixelTrack sights;  // frames count from the first that is kept
    std::vector<double> scales_px;
    Descriptor descriptor{};
    AlongRange along;
    bool mapped = false;
  };

  void settle(std::size_t frames, std::size_t settled_after, std::vector<MappedLandmark>& mapped);
  void forget_settled();

  Pinhole camera_;
  LandmarkSettings settings_;
  std::vector<RecordedPose> frames_;  // those that are kept
  std::size_t settled_ = 0;           // of frames_, whose poses are final
  std::vector<WaitingTrack> tracks_;  // in the order they ended
};

}  // namespace milepost
