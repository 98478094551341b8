// Checks a condition that must hold for any input. Unlike an assert it is active in every build.
#pragma once

#include <cstdlib>

namespace milepost::fuzz {

inline void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace milepost::fuzz
