// How likely a place in the plan is whose error has heavier tails than a normal one's.
#pragma once

#include <cmath>

namespace milepost {

// Logarithm of the density of Student's t in two dimensions, so many squared sigmas off, up to a
// constant. REQUIRES: degrees > 0.
inline double log_student_t(double squared_sigmas, double degrees) {
  return -(degrees + 2) / 2 * std::log1p(squared_sigmas / degrees);
}

}  // namespace milepost
