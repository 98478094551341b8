// The descriptors of a feature, of a tracklet, and of a whole image.
#pragma once

#include <array>
#include <cstdint>

namespace milepost {

inline constexpr int kDescriptorBytes = 128;

// SIFT's 4 x 4 cells of 8 orientations, one byte each as OpenCV scales them.
using Descriptor = std::array<std::uint8_t, kDescriptorBytes>;

inline constexpr int kImageDescriptorValues = 64;

// SURF's 4 x 4 cells of 4 values, of length 1 (schema/feature/wisurf.h); all 0 of a uniform image.
using ImageDescriptor = std::array<float, kImageDescriptorValues>;

// Euclidean, in [0, 2].
double image_distance(const ImageDescriptor& a, const ImageDescriptor& b);

}  // namespace milepost
