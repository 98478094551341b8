// The bands of an image that are used.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "schema/base/result.h"

class GDALDataset;

namespace milepost {

// Bands of an image by their meaning, counted from 1.
struct ImageBands {
  std::vector<int> shown;    // one (grey or a palette) or three (red, green, blue)
  int alpha = 0;             // 0: none
  int distrusted_alpha = 0;  // tagged as transparency, but it holds data; 0: none
};

// One band of grey or three of red, green and blue, optionally followed by one of transparency.
// Errors: invalid_input (not one to four numbers from 1, or one of them twice).
Result<ImageBands> bands_named(const std::vector<int>& numbers);

// The bands by the image's tags. A band tagged as transparency is distrusted if, in a sample of the
// image, more than half of its values above 0 are below 255: masks are nearly all 0 or 255, even
// with feathered edges, while near infrared is tagged so by mistake. Errors: corrupt (the sample
// cannot be read).
Result<ImageBands> bands_by_tags(GDALDataset& image, const std::filesystem::path& file);

// Whether the image has these bands and their values are bytes. Errors: invalid_input.
Status check_bands(GDALDataset& image, const ImageBands& bands, const std::filesystem::path& file);

}  // namespace milepost
