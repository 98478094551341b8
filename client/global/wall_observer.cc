#include "client/global/wall_observer.h"

namespace milepost {

WallObserver::WallObserver(const Pinhole& view, const ObserverSettings& settings)
    : view_(view), settings_(settings), points_(view, settings.points) {}

WallObservation WallObserver::observe(const cv::Mat& gray, const OdometryIncrement& motion) {
  const VanishingDirections directions = vanishing_directions(gray, view_, settings_.vanishing);
  WallObservation observation{view_sections(directions, view_), {}};
  if (settings_.with_beams) {
    observation.beams =
        beams_of(points_.observe(gray, motion), level_from_camera(directions), settings_.beams);
  }
  return observation;
}

}  // namespace milepost
