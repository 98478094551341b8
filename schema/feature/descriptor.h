// The descriptor of a feature, and of a tracklet.
#pragma once

#include <array>
#include <cstdint>

namespace milepost {

inline constexpr int kDescriptorBytes = 128;

// SIFT's 4 x 4 cells of 8 orientations, one byte each as OpenCV scales them.
using Descriptor = std::array<std::uint8_t, kDescriptorBytes>;

}  // namespace milepost
