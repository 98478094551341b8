// The log-density of a position error in the plane with heavier tails than a normal distribution.
#pragma once

#include <cmath>

namespace milepost {

// Log-density of the bivariate Student's t distribution at a squared Mahalanobis distance, up to a
// constant. REQUIRES: degrees > 0.
inline double log_student_t(double squared_sigmas, double degrees) {
  return -(degrees + 2) / 2 * std::log1p(squared_sigmas / degrees);
}

}  // namespace milepost
