// Weight functions of robust least squares: even, with value 1 at a residual of 0.
#pragma once

#include <algorithm>

namespace milepost {

// Cauchy's: 1/2 at `width`.
inline double cauchy_weight(double residual, double width) {
  const double u = residual / width;
  return 1 / (1 + u * u);
}

// Geman and McClure's: 1/4 at `width`.
inline double geman_mcclure_weight(double residual, double width) {
  const double cauchy = cauchy_weight(residual, width);
  return cauchy * cauchy;
}

// Tukey's biweight: 0 from `cutoff` on.
inline double biweight(double residual, double cutoff) {
  const double u = residual / cutoff;
  const double inside = std::max(0.0, 1 - u * u);
  return inside * inside;
}

}  // namespace milepost
