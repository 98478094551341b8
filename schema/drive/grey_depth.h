// Which grey values of a recording are white: 16-bit images often hold values of fewer bits.
#pragma once

#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

namespace milepost {

// How many bits the grey values of a recording's images have: 8, 10, 12, 14 or 16. As many as the
// images declare, if that is less than 16 (PNG's sBIT, the greatest value in the header of a PGM or
// PPM or in a TIFF's MaxSampleValue), and as their greatest value needs; both of up to 16 images,
// evenly spread and always the same ones. Images of 8 bits say nothing, and those that cannot be
// read neither.
int grey_bits_of(const std::vector<std::filesystem::path>& images);

// The 8 most significant of `bits` bits of each value; greater values become 255.
// REQUIRES: CV_16UC1, 8 <= bits <= 16.
cv::Mat in_8_bits(const cv::Mat& gray, int bits);

}  // namespace milepost
