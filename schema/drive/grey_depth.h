// The bit depth of a recording's grey values: 16-bit images often hold values of fewer bits.
#pragma once

#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

namespace milepost {

// The bit depth of a recording's grey values: 8, 10, 12, 14 or 16. It is the least that covers the
// depth which the images declare, if that is below 16 (PNG's sBIT, the greatest value in the header
// of a PGM or PPM or in a TIFF's MaxSampleValue), and their greatest value; both over up to 16
// images, evenly spread and always the same ones. Images of 8 bits and unreadable ones are ignored.
int grey_bits_of(const std::vector<std::filesystem::path>& images);

// The 8 most significant of `bits` bits of each value; greater values become 255.
// REQUIRES: CV_16UC1, 8 <= bits <= 16.
cv::Mat in_8_bits(const cv::Mat& gray, int bits);

}  // namespace milepost
