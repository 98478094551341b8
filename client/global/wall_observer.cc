#include "client/global/wall_observer.h"

namespace milepost {

WallObserver::WallObserver(const Camera& camera, const ObserverSettings& settings)
    : camera_(camera), settings_(settings), points_(camera, settings.points) {}

WallObservation WallObserver::observe(const cv::Mat& gray, const OdometryIncrement& motion) {
  const VanishingDirections directions = vanishing_directions(gray, camera_, settings_.vanishing);
  WallObservation observation{view_sections(directions, camera_.pinhole), {}};
  if (settings_.with_beams) {
    observation.beams =
        beams_of(points_.observe(gray, motion), level_from_camera(directions), settings_.beams);
  }
  return observation;
}

}  // namespace milepost
