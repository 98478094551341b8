#include "client/evaluate/report/robust_reach.h"

#include <algorithm>
#include <cmath>

#include "client/evaluate/statistics.h"

namespace milepost {

double robust_reach(std::vector<double> magnitudes) {
  magnitudes = finite_only(magnitudes);
  constexpr double kHeadroom = 1.05;  // keeps the mark of the largest value inside the plot
  if (magnitudes.empty()) return 0;
  for (double& each : magnitudes) each = std::abs(each);
  std::sort(magnitudes.begin(), magnitudes.end());
  const double usual = quantile(magnitudes, 0.9);
  return kHeadroom * (usual > 0 ? std::min(magnitudes.back(), 2.5 * usual) : magnitudes.back());
}

}  // namespace milepost
