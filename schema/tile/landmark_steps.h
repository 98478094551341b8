// A landmark quantized as stored in tiles (FORMAT.md 5.4 to 5.11).
#pragma once

#include <cstdint>

#include "schema/feature/pca_projection.h"
#include "schema/tile/landmark.h"

namespace milepost {

struct LandmarkSteps {
  CompactDescriptor descriptor{};
  std::int16_t east_cm = 0;
  std::int16_t north_cm = 0;
  std::int16_t up_cm = 0;
  std::uint8_t depth_sigma = 0;  // steps of 5 % below 100 m
  std::uint8_t size = 0;         // steps of 5 % below 100 m
  std::uint8_t size_sigma = 0;   // in 1/250, at most 250
  std::uint16_t begin_dm = 0;    // from the tile's origin
  std::uint16_t length_dm = 0;
  std::uint8_t observations = 0;
  std::uint8_t passes = 1;
  std::int8_t right_dm = 0;  // at least -127
};

inline constexpr std::uint8_t kSizeSigmaUnits = 250;
inline constexpr std::int8_t kLeastRightDm = -127;

// Rounds to the nearest steps; values out of range saturate. `origin_m` is the tile's.
LandmarkSteps steps_of(const Landmark& landmark, double origin_m);

// steps_of(landmark_of(steps)) == steps, for origins in [-10^8, 10^8] m.
Landmark landmark_of(const LandmarkSteps& steps, double origin_m);

}  // namespace milepost
