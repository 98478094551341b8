// Procedural roofs, and fittings on and in front of houses.
#pragma once

#include <opencv2/core.hpp>

namespace milepost::simulator {

inline constexpr int kRoofTexelsPerM = 20;

// Each paints a piece of the given size in metres, [rows across] x [columns along].
cv::Mat paint_tiles(double width_m, double height_m, cv::RNG& random);
cv::Mat paint_flat_roof(double width_m, double height_m, cv::RNG& random);
cv::Mat paint_brick(double width_m, double height_m, int texels_per_m, cv::RNG& random);
cv::Mat paint_metal(double width_m, double height_m, int texels_per_m, cv::RNG& random);
// Striped cloth.
cv::Mat paint_awning(double width_m, double height_m, int texels_per_m, cv::RNG& random);
// Upright bars with opacity, BGRA.
cv::Mat paint_railing(double width_m, double height_m, int texels_per_m, cv::RNG& random);
// A shop's board with a sign.
cv::Mat paint_board(double width_m, double height_m, int texels_per_m, cv::RNG& random);

}  // namespace milepost::simulator
