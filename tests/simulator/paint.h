// Small tools for painting textures.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace milepost::simulator {

// A number in [0, 1) that depends on a lattice point and the seed only.
float lattice_noise(std::int64_t x, std::int64_t y, std::uint64_t seed);

// Smooth noise in [0, 1) whose bumps are one unit wide.
float smooth_noise(double x, double y, std::uint64_t seed);

// A generator whose first numbers are uncorrelated for similar seeds.
cv::RNG seeded(std::uint64_t seed);

// `colour` brightened by `factor`.
cv::Scalar shaded(const cv::Scalar& colour, double factor);

// A colour near `colour`; each of its channels differs by up to `spread`.
cv::Scalar varied(const cv::Scalar& colour, double spread, cv::RNG& random);

// Makes `image` grainy: fine grain of the given standard deviation and soft stains.
void weather(cv::Mat& image, double grain, double stains, cv::RNG& random);

}  // namespace milepost::simulator
