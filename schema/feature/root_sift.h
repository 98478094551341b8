// RootSIFT (Arandjelovic and Zisserman, "Three things everyone should know to improve object
// retrieval", CVPR 2012): square roots of the values of a descriptor scaled to sum 1. Euclidean
// distances of RootSIFT are Hellinger distances of SIFT.
#pragma once

#include <array>
#include <cstdint>

#include "schema/feature/descriptor.h"

namespace milepost {

// 255 * 128, so that a mean in 1/255 is a whole number of them and a difference fits 16 bits.
inline constexpr int kRootSiftUnits = 32640;

// Of length 1, in 1/kRootSiftUnits; all 0 of an all-zero descriptor. The same on every machine.
using RootSift = std::array<std::int16_t, kDescriptorBytes>;

RootSift root_sift(const Descriptor& descriptor);

}  // namespace milepost
