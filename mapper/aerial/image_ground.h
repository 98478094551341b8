// The position of an image on the Earth, and the size of its pixels there.
#pragma once

#include <filesystem>
#include <string>

#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

class GDALDataset;

namespace milepost {

// Walls are not visible in coarser pixels: a house is about eight of them long. Web maps have
// pixels of this size at zoom level 17.
inline constexpr double kCoarsestPixelM = 1.2;
// From an image's middle to its corners. The scale of a ground frame is accurate to 1e-4 there.
inline constexpr double kMaxReachM = 100'000;

struct ImageGround {
  GeoPoint middle;
  double finest_pixel_m = 0;  // the shorter side of the pixel in the middle, on the ground
  std::string reference;      // the image's coordinate reference system, for GDAL
  // Whether coordinates continue beyond the edge of a world map, at longitude 180. Then those of
  // the target must, too: ` +over` after its PROJ string.
  bool goes_beyond_180 = false;
};

// `reference` is the coordinate reference system, as EPSG:3857 or in any other form that GDAL
// accepts, of an image that does not state it; else it may be empty. No pixels are read. Errors:
// invalid_input (no georeference; one without a position on the Earth in the middle or at a
// corner; pixels coarser than kCoarsestPixelM there; corners beyond kMaxReachM).
Result<ImageGround> ground_of(GDALDataset& image, const std::string& reference,
                              const std::filesystem::path& file);

}  // namespace milepost
