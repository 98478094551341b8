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

// The ground positions of pixels: rows run east, columns run south. Pixel coordinates are relative
// to the centre of the top left pixel.
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
  cv::Mat bgr;      // CV_8UC3; of a grey image, three equal channels
  cv::Mat covered;  // CV_8UC1, 255 where the image has data, else 0
  PixelGrid grid;
};

struct ImageSource {
  std::filesystem::path file;
  // The coordinate reference system of an image that does not state it, such as one with a world
  // file: EPSG:3857, or in any other form that GDAL accepts.
  std::string reference;
  std::vector<int> bands;  // as for bands_named; empty: by the image's tags
};

// Any image that GDAL reads: any projection, grey, colours or a palette, with or without
// transparency. Not safe to use from several threads at once.
class Orthoimage {
 public:
  // No pixels are read except a sample of an alpha band. Errors: not_found; those of bands_named,
  // bands_by_tags, check_bands and ground_of; invalid_input (not an image, or one that cannot be
  // read in small parts).
  static Result<Orthoimage> open(const ImageSource& from, double metres_per_pixel);

  Orthoimage(Orthoimage&&) noexcept;
  Orthoimage& operator=(Orthoimage&&) noexcept;
  ~Orthoimage();

  cv::Size size() const;  // in pixels of metres_per_pixel
  const GroundFrame& frame() const;
  const ImageBands& bands() const;
  Bounds bounds() const;  // the bounding box of the image; it may cross longitude 180

  // The part of `block` within the image. Errors: corrupt (the file is damaged there).
  // REQUIRES: `block` intersects the image.
  Result<Picture> read(const cv::Rect& block) const;

 private:
  struct Impl;
  explicit Orthoimage(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
