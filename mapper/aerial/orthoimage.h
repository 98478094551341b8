// An orthoimage, resampled block by block to square pixels of a given size on the ground.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "mapper/aerial/ground_frame.h"
#include "schema/base/cell_grid.h"
#include "schema/base/result.h"

namespace milepost {

// Where pixels lie on the ground: rows run east, columns run south. Pixels count from the centre of
// the top left one.
struct PixelGrid {
  double west_m = 0;   // of the top left pixel's outer corner
  double north_m = 0;  // of the same
  double metres_per_pixel = 0.1;

  Eigen::Vector2d ground_from_pixel(const Eigen::Vector2d& pixel) const {
    return {west_m + (pixel.x() + 0.5) * metres_per_pixel,
            north_m - (pixel.y() + 0.5) * metres_per_pixel};
  }
  Eigen::Vector2d pixel_from_ground(const Eigen::Vector2d& ground_m) const {
    return {(ground_m.x() - west_m) / metres_per_pixel - 0.5,
            (north_m - ground_m.y()) / metres_per_pixel - 0.5};
  }
};

// A block of the picture.
struct Picture {
  cv::Mat bgr;      // CV_8UC3; a grey image has three equal channels
  cv::Mat covered;  // CV_8UC1, 255 where the image has data, else 0
  PixelGrid grid;
};

// Whatever GDAL reads: any projection, grey, colours or a palette, with or without transparency.
// Not safe to use from several threads at once.
class Orthoimage {
 public:
  // `reference`, as EPSG:3857 or in any other way that GDAL knows, says what the image's
  // coordinates are where the image does not, as one with a world file; else it may be empty.
  // Errors: not_found; invalid_input (no image, no georeference, pixels that are not bytes).
  static Result<Orthoimage> open(const std::filesystem::path& file, const std::string& reference,
                                 double metres_per_pixel);

  Orthoimage(Orthoimage&&) noexcept;
  Orthoimage& operator=(Orthoimage&&) noexcept;
  ~Orthoimage();

  cv::Size size() const;  // in pixels of metres_per_pixel
  const GroundFrame& frame() const;
  Bounds bounds() const;  // a box around the whole image

  // The part of `block` that lies in the image. Errors: corrupt (the file is damaged there).
  // REQUIRES: `block` meets the image.
  Result<Picture> read(const cv::Rect& block) const;

 private:
  struct Impl;
  explicit Orthoimage(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
