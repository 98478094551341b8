// Extracts the measurements of the walls around the vehicle from a frame.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "client/global/range_likelihood.h"
#include "client/global/scene_points.h"
#include "client/global/vanishing_directions.h"
#include "client/global/view_sections.h"
#include "schema/geo/camera.h"

namespace milepost {

struct WallObservation {
  std::vector<ViewSection> sections;  // orientations by bearing: the paper's
  std::vector<Beam> beams;            // ranges by bearing: ours
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
  WallObserver(const Camera& camera, const ObserverSettings& settings);

  // `motion` is the odometry since the last call. REQUIRES: `gray` is CV_8UC1 and not empty.
  WallObservation observe(const cv::Mat& gray, const OdometryIncrement& motion);

 private:
  Camera camera_;
  ObserverSettings settings_;
  ScenePointTracker points_;
};

}  // namespace milepost
