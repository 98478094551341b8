// Which bands of an image are looked at.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "schema/base/result.h"

class GDALDataset;

namespace milepost {

// Bands of an image by what they show, counted from 1.
struct ImageBands {
  std::vector<int> shown;    // one (grey or a palette) or three (red, green, blue)
  int alpha = 0;             // 0: none
  int distrusted_alpha = 0;  // tagged as transparency, but it holds data; 0: none
};

// One band of grey or three of red, green and blue, and perhaps one of transparency after them.
// Errors: invalid_input (not one to four numbers from 1, or one of them twice).
Result<ImageBands> bands_named(const std::vector<int>& numbers);

// The bands by what the image says of them. A band tagged as transparency of which more than half
// of the values above 0, in a sample of the image, are below 255 is distrusted: masks are nearly
// all 0 or 255, even with feathered edges, while near infrared is tagged so by mistake. Errors:
// corrupt (the sample cannot be read).
Result<ImageBands> bands_by_tags(GDALDataset& image, const std::filesystem::path& file);

// Whether the image has these bands and their values are bytes. Errors: invalid_input.
Status check_bands(GDALDataset& image, const ImageBands& bands, const std::filesystem::path& file);

}  // namespace milepost
