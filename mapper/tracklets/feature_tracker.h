// Tracks features over consecutive frames (the tracklet paper, section 4.1).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "schema/feature/descriptor_index.h"
#include "schema/tile/observation.h"

namespace milepost {

struct FeatureTrackingSettings {
  std::size_t min_observations = 3;  // shorter tracks are discarded
  double max_distance_ratio = 0.8;   // nearest neighbour distance ratio, of descriptor distances
  double max_distance = 300;         // between the descriptors of one feature in two frames
  double max_displacement = 0.25;    // of a feature without known motion, in image widths
  double min_scale_growth = 0.8;     // scale in one frame relative to the frame before
  double max_scale_growth = 1.7;
  double search_radius_px = 12;    // around the predicted position ...
  double search_per_motion = 0.5;  // ... plus this share of the predicted motion
  IndexSettings index;
};

// A feature without known motion is matched globally to the next frame by FLANN with the ratio
// test. After that its next position is predicted from its motion, and matching is guided by a
// search area around it. Each feature of a frame belongs to one track at most. Not safe to use from
// several threads.
class FeatureTracker {
 public:
  FeatureTracker(const FeatureTrackingSettings& settings, int image_width_px);

  // Adds the next frame and returns the tracks that it does not continue, in the order they began.
  // REQUIRES: `along_m` is greater than that of the frame before.
  std::vector<Track> add(const FeatureSet& frame, double along_m);
  // Ends every track and returns those still open, in the order they began.
  std::vector<Track> finish();
  // Arc length at which the oldest open track of any length begins. REQUIRES: a frame was added.
  double oldest_open_along_m() const;

 private:
  struct Link {  // candidate continuation of a track by a feature of the new frame
    std::size_t track;
    std::size_t feature;
    float distance_squared;
  };

  std::vector<Link> links_by_ratio(const FeatureSet& frame) const;
  std::vector<Link> links_by_motion(const FeatureSet& frame, double along_m) const;
  bool scale_grows_plausibly(const Feature& before, const Feature& after) const;
  void keep_if_long(Track track, std::vector<Track>& kept) const;

  FeatureTrackingSettings settings_;
  int image_width_px_;
  std::vector<Track> open_;  // each ends in the latest frame
};

}  // namespace milepost
