// Where an image lies on the Earth, and how large its pixels are there.
#pragma once

#include <filesystem>
#include <string>

#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

class GDALDataset;

namespace milepost {

// Coarser pixels show no walls: a house is about eight of them long. Web maps have such at zoom
// level 17.
inline constexpr double kCoarsestPixelM = 1.2;
// From an image's middle to its corners. Metres of a ground frame are true to 1e-4 there.
inline constexpr double kMaxReachM = 100'000;

struct ImageGround {
  GeoPoint middle;
  double finest_pixel_m = 0;  // the shorter side of the pixel in the middle, on the ground
  std::string reference;      // what the image's coordinates are, as GDAL reads it
  // Whether they go on beyond the edge of a world map, at longitude 180. Then those of what the
  // image is brought to must, too: ` +over` after its PROJ string.
  bool goes_beyond_180 = false;
};

// `reference`, as EPSG:3857 or in any other way that GDAL knows, says what the coordinates are
// where the image does not; else it may be empty. Nothing of the pixels is read. Errors:
// invalid_input (no georeference; one that leads nowhere on the Earth in the middle or at a corner;
// pixels coarser than kCoarsestPixelM there; corners beyond kMaxReachM).
Result<ImageGround> ground_of(GDALDataset& image, const std::string& reference,
                              const std::filesystem::path& file);

}  // namespace milepost
