// From a frame to what it tells of the walls about the vehicle.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "client/global/range_agreement.h"
#include "client/global/scene_points.h"
#include "client/global/vanishing_directions.h"
#include "client/global/wall_sightings.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct WallObservation {
  std::vector<ViewSection> sections;  // orientations by bearing: the paper's
  std::vector<Beam> beams;            // points by bearing: ours
};

struct ObserverSettings {
  VanishingSettings vanishing;
  bool with_beams = true;
  ScenePointSettings points;
  BeamSettings beams;
};

// Not safe to use from several threads at once.
class WallObserver {
 public:
  WallObserver(const Pinhole& view, const ObserverSettings& settings);

  // `motion` is that since the last call. REQUIRES: `gray` is CV_8UC1 and not empty.
  WallObservation observe(const cv::Mat& gray, const WheelMotion& motion);

 private:
  Pinhole view_;
  ObserverSettings settings_;
  ScenePointTracker points_;
};

}  // namespace milepost
