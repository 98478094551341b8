// Made-up descriptors.
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "schema/feature/descriptor.h"

namespace milepost::testing {

// Descriptors that do not resemble each other.
inline std::vector<Descriptor> unlike_descriptors(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<Descriptor> descriptors(count);
  for (Descriptor& descriptor : descriptors) {
    for (std::uint8_t& value : descriptor) {
      value = static_cast<std::uint8_t>(255 * std::pow(uniform(random), 6));
    }
  }
  return descriptors;
}

}  // namespace milepost::testing
