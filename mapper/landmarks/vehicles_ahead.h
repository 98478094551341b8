// Vehicles that drive ahead of the mapping vehicle. What is seen on them is no landmark.
#pragma once

#include <deque>
#include <vector>

#include "mapper/landmarks/feature_track.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct VehiclesAheadSettings {
  double min_track_m = 6;  // driven while a track that tells was seen, ...
  std::size_t min_observations = 4;
  double min_recession_px = 1.5;     // ... and its recession, if it recedes, ...
  double max_recession_a_m = 0.006;  // ... in focal lengths a metre driven; a wrong match has more
  double reach_m = 100;              // of what a track tells, along the drive ...
  double reach_focal = 0.07;         // ... and in the image, in focal lengths
  std::size_t min_receding = 6;      // tracks in one place that tell a vehicle, ...
  double min_part = 0.15;            // ... and their part of all tracks there
  double min_distance_m = 40;        // nearer landmarks are not on a vehicle that falls back
};

// By how much a feature has come nearer to the direction of motion between its first and its last
// observation, after the camera's turn. A standing feature's is below zero.
double recession_px(const FeatureTrack& track, const std::vector<CameraPose>& poses,
                    const Pinhole& camera);

// Where a vehicle ahead draws away, the features on it recede. Where it falls back, they move as if
// they stood, gap / (change of the gap a metre) ahead, and fit as well as any landmark; but they
// are in the place in the image where others receded before or will. Not safe to use from several
// threads.
class VehiclesAhead {
 public:
  VehiclesAhead(const VehiclesAheadSettings& settings, const Pinhole& camera)
      : settings_(settings), focal_px_(camera.focal_px()) {}

  // What was seen of a track: along the drive and in the image, its middle.
  struct Place {
    double along_m = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  };

  // Adds a track.
  void add(const Place& place, double driven_m, std::size_t observations, double recession_px);
  // Whether a landmark that was seen there is on a vehicle. REQUIRES: all tracks within reach_m()
  // of it were added.
  bool hold(const Place& place, double distance_m) const;
  // Forgets what is no longer asked for: landmarks before `along_m`.
  void forget_before(double along_m);

  double reach_m() const { return settings_.reach_m; }

 private:
  struct Told {
    Place place;
    bool recedes = false;
  };

  bool recede(const Place& place, double from_m, double to_m) const;

  VehiclesAheadSettings settings_;
  double focal_px_;
  std::deque<Told> told_;
};

}  // namespace milepost
