// An orthoimage, resampled block by block to square pixels of a given size on the ground.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "mapper/aerial/ground_frame.h"
#include "mapper/aerial/image_bands.h"
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

struct ImageSource {
  std::filesystem::path file;
  // What the image's coordinates are, where it does not say, as one with a world file: EPSG:3857,
  // or in any other way that GDAL knows.
  std::string reference;
  std::vector<int> bands;  // as bands_named has them; empty: what the image says of them
};

// Whatever GDAL reads: any projection, grey, colours or a palette, with or without transparency.
// Not safe to use from several threads at once.
class Orthoimage {
 public:
  // No pixels are read but a sample of a band of transparency. Errors: not_found; those of
  // bands_named, bands_by_tags, check_bands and ground_of; invalid_input (no image, or one of which
  // no small part can be read for itself).
  static Result<Orthoimage> open(const ImageSource& from, double metres_per_pixel);

  Orthoimage(Orthoimage&&) noexcept;
  Orthoimage& operator=(Orthoimage&&) noexcept;
  ~Orthoimage();

  cv::Size size() const;  // in pixels of metres_per_pixel
  const GroundFrame& frame() const;
  const ImageBands& bands() const;
  Bounds bounds() const;  // a box around the whole image; it may cross longitude 180

  // The part of `block` that lies in the image. Errors: corrupt (the file is damaged there).
  // REQUIRES: `block` meets the image.
  Result<Picture> read(const cv::Rect& block) const;

 private:
  struct Impl;
  explicit Orthoimage(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
