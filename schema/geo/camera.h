// The camera model: image size, pinhole, lens and mounting (FRAMES.md 7 and 8).
#pragma once

#include <optional>

#include <Eigen/Core>

#include "schema/geo/lens.h"
#include "schema/geo/mounting.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// Features are found in the lens's image and everything else is computed in the image that a
// pinhole without distortion would give, whose pixels may lie outside the lens's image.
struct Camera {
  int width_px = 0;
  int height_px = 0;
  Pinhole pinhole = {};
  Lens lens = {};
  Mounting mounting = {};

  // Where the lens shows what lies at a pixel of the pinhole's image; nothing beyond its field of
  // view.
  std::optional<Eigen::Vector2d> image_from_pinhole(const Eigen::Vector2d& pinhole_px) const;

  struct Undistorted {
    Eigen::Vector2d pinhole_px;
    double magnification = 1;  // pixels of the pinhole's image per pixel of the lens's
  };
  // The inverse.
  std::optional<Undistorted> pinhole_from_image(const Eigen::Vector2d& image_px) const;

  friend bool operator==(const Camera&, const Camera&) = default;
};

}  // namespace milepost
