#include "schema/geo/camera.h"

namespace milepost {
namespace {

Eigen::Vector2d plane_from_pixel(const Pinhole& pinhole, const Eigen::Vector2d& pixel) {
  return pinhole.unproject(pixel.x(), pixel.y()).head<2>();
}

Eigen::Vector2d pixel_from_plane(const Pinhole& pinhole, const Eigen::Vector2d& point) {
  return pinhole.project(Eigen::Vector3d(point.x(), point.y(), 1));
}

}  // namespace

std::optional<Eigen::Vector2d> Camera::image_from_pinhole(const Eigen::Vector2d& pinhole_px) const {
  if (lens.is_pinhole()) return pinhole_px;
  const auto shown = lens.distorted(plane_from_pixel(pinhole, pinhole_px));
  if (!shown) return std::nullopt;
  return pixel_from_plane(pinhole, *shown);
}

std::optional<Camera::Undistorted> Camera::pinhole_from_image(
    const Eigen::Vector2d& image_px) const {
  if (lens.is_pinhole()) return Undistorted{image_px};
  const auto found = lens.undistorted(plane_from_pixel(pinhole, image_px));
  if (!found) return std::nullopt;
  return Undistorted{pixel_from_plane(pinhole, found->seen), found->magnification};
}

}  // namespace milepost
