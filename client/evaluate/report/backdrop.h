// An aerial background image for the plans of a report.
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include <opencv2/core.hpp>

#include "schema/base/bytes.h"
#include "schema/base/cell_grid.h"
#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// The six numbers that georeference an image: pixel (column, row) has its centre at longitude c + a
// * column + b * row, latitude f + d * column + e * row, in WGS84 degrees. The file lists them in
// the order a, d, b, e, c, f, one per line.
struct WorldFile {
  double a = 0, d = 0, b = 0, e = 0, c = 0, f = 0;

  // The position of a point in pixels from the centre of the top left pixel; altitude 0.
  GeoPoint at(const cv::Point2d& pixel) const {
    return {f + d * pixel.x + e * pixel.y, c + a * pixel.x + b * pixel.y, 0};
  }
  // The signed area of a pixel in square degrees; 0 is invalid.
  double determinant() const { return a * e - b * d; }
  // The inverse of at(). REQUIRES: the determinant is not 0.
  cv::Point2d project(double latitude_deg, double longitude_deg) const;
};

struct Backdrop {
  cv::Mat bgr;  // 8 bits
  WorldFile world;

  Bounds bounds() const;  // around the whole image
};

// Reads an image in a format supported by OpenCV (PNG, JPEG) and the world file next to it, with
// the extension .wld or the usual one of the format (.pgw, .jgw). Errors: not_found, io;
// invalid_input for an image that is truncated or cannot be decoded, a line of the world file that
// is not a number (named), or numbers outside valid WGS84 degrees.
Result<Backdrop> read_backdrop(const std::filesystem::path& image);

// The part of an image that is embedded in a page.
struct PagePicture {
  Bytes jpeg;
  // Its outer corners, altitude 0.
  GeoPoint top_left, top_right, bottom_left;
};

// The part of the image around the box, scaled down to page size and nearly grey, so that coloured
// marks stand out; none if the box lies outside. REQUIRES: the box does not cross longitude 180.
std::optional<PagePicture> page_picture(const Backdrop& backdrop, const Bounds& shown);

}  // namespace milepost
