#include "mapper/fusion/variance_components.h"

#include <algorithm>

#include <boost/math/distributions/students_t.hpp>

namespace milepost {

ErrorVector on_axes(const ByKind& of_kind) {
  return {of_kind[0], of_kind[0], of_kind[0], of_kind[1]};
}

ByKind common_variances(const std::vector<Squares>& squares, double usual_m2, const ByKind& least) {
  ByKind medians = least;
  for (Eigen::Index kind = 0; kind < medians.size(); ++kind) {
    std::vector<double> means;
    means.reserve(squares.size());
    for (const Squares& each : squares) {
      if (kind == 0 && each.is_stated) continue;
      means.push_back(each.sums[kind] / each.counts[kind]);
    }
    if (means.empty()) means.push_back(usual_m2);
    std::ranges::sort(means);
    const std::size_t middle = means.size() / 2;
    const double median =
        means.size() % 2 == 1 ? means[middle] : (means[middle - 1] + means[middle]) / 2;
    medians[kind] = std::max(median, medians[kind]);
  }
  return medians;
}

ByKind drawn_variances(const Squares& own, ByKind common, double prior, double stated_m2) {
  if (own.is_stated) common[0] = stated_m2;
  ByKind drawn = ((prior * common + own.sums).array() / (prior + own.counts.array())).matrix();
  if (own.is_stated) drawn[0] = std::max(drawn[0], common[0]);
  return drawn;
}

double few_values_factor(std::size_t values) {
  constexpr double kBeyondTwoSigma = 0.02275;  // of a normal distribution, on one side
  const boost::math::students_t few(static_cast<double>(values));
  const double two_sigma = boost::math::quantile(boost::math::complement(few, kBeyondTwoSigma));
  return two_sigma * two_sigma / 4;
}

}  // namespace milepost
