// Surveyed marks and the places where they are seen in images: how a map is accepted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/geo/datum.h"
#include "schema/geo/geodesy.h"

namespace milepost {

struct CheckPointSight {
  std::string drive;  // its name
  std::string filename;
  Eigen::Vector2d image_px;  // in the image as the camera took it
};

struct CheckPoint {
  std::string mark;
  GeoPoint position;
  std::vector<CheckPointSight> sights;
};

// A table with a row for each sight: mark; latitude_deg, longitude_deg and altitude_m of `datum`,
// or x, y and z of the reference system `crs`, if that is not empty; filename, x_px and y_px;
// drive, which may be left out if there is one. Other columns are ignored. Errors: not_found, io;
// invalid_input, also for a mark with two positions, for an image that no drive has, and for a crs
// whose datum cannot be transformed to that of the map.
Result<std::vector<CheckPoint>> read_check_points(const std::filesystem::path& file,
                                                  const std::string& crs, const Datum& datum,
                                                  const std::vector<Drive>& drives);

}  // namespace milepost
