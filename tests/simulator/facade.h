// Procedural fronts of houses, garden walls, poles and signs.
#pragma once

#include <opencv2/core.hpp>

namespace milepost::simulator {

// Texels of a metre of house.
inline constexpr int kFacadeTexelsPerM = 64;

// Each paints a texture of the given size in metres; `random` decides the style and every detail.
cv::Mat paint_facade(double width_m, double height_m, cv::RNG& random);
cv::Mat paint_side_wall(double width_m, double height_m, cv::RNG& random);
cv::Mat paint_garden_wall(double width_m, double height_m, cv::RNG& random);
cv::Mat paint_traffic_sign(double side_m, cv::RNG& random);
cv::Mat paint_pole(double width_m, double height_m, cv::RNG& random);

}  // namespace milepost::simulator
