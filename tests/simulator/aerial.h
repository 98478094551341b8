// Aerial data of the town: a georeferenced orthoimage, and the true outlines of its houses.
#pragma once

#include <filesystem>

#include "schema/base/result.h"
#include "tests/simulator/record.h"
#include "tests/simulator/town.h"

namespace milepost::simulator {

// The transverse Mercator grid about the town's origin, as a PROJ string. Its metres east and north
// are those of the drives' local frame, to a centimetre within the town.
std::string town_grid();

struct OrthoPlan {
  cv::Vec2d south_west;  // east, north
  cv::Vec2d north_east;
  double pixel_m = 0.1;
};

// The whole town.
OrthoPlan ortho_of(const Network& network);

// Renders a GeoTIFF, strip by strip on `threads` threads: its memory does not grow with the height.
// REQUIRES: the town was made with GroundDetail::aerial. Errors: io, cancelled.
Status write_orthoimage(const Town& town, const Lighting& lighting, const OrthoPlan& plan,
                        const std::filesystem::path& path, int threads,
                        const Progress& progress = {});

// GeoJSON in WGS84: one polygon per house, with its height_m and eaves_m above the ground. Errors:
// io.
Status write_walls(const Town& town, const std::filesystem::path& path);

}  // namespace milepost::simulator
