// A picture from above that a report shows beneath its plans.
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

// Six numbers that place a picture on the Earth: a pixel (column, row) has its centre at longitude
// c + a * column + b * row, latitude f + d * column + e * row, in WGS84 degrees. The file has them
// in the order a, d, b, e, c, f, one a line.
struct WorldFile {
  double a = 0, d = 0, b = 0, e = 0, c = 0, f = 0;

  // Of a place in the picture, in pixels from the centre of its top left one; altitude 0.
  GeoPoint at(const cv::Point2d& pixel) const {
    return {f + d * pixel.x + e * pixel.y, c + a * pixel.x + b * pixel.y, 0};
  }
  // How much a pixel covers, in square degrees, with a sign; 0 for none.
  double determinant() const { return a * e - b * d; }
  // The inverse of at(). REQUIRES: the determinant is not 0.
  cv::Point2d pixel_of(double latitude_deg, double longitude_deg) const;
};

struct Backdrop {
  cv::Mat bgr;  // 8 bits
  WorldFile world;

  Bounds bounds() const;  // around all of it
};

// Reads a picture in a format of OpenCV's (PNG, JPEG) and the world file beside it: with the ending
// .wld, or with the usual one of the format (.pgw, .jgw).
// Errors: not_found, io; invalid_input for an image that is cut short or cannot be decoded, a line
// of the world file that is no number (named), or numbers that are no WGS84 degrees.
Result<Backdrop> read_backdrop(const std::filesystem::path& image);

// What a page shows of a picture.
struct PagePicture {
  Bytes jpeg;
  // Its outer corners, altitude 0.
  GeoPoint top_left, top_right, bottom_left;
};

// Of the picture the part around the box, scaled down to a size that fits a page and nearly grey,
// so that what is drawn over it stands out by its colour; none where the box lies outside.
// REQUIRES: the box does not cross longitude 180.
std::optional<PagePicture> page_picture(const Backdrop& backdrop, const Bounds& shown);

}  // namespace milepost
