#include "client/localize/estimate.h"

#include <algorithm>
#include <cmath>

#include "client/estimation/robust_weights.h"

namespace milepost {
namespace {

// The mode of the estimates, each weighted by its certainty.
double densest_along_m(const std::vector<PositionEstimate>& estimates, double width_m) {
  double densest_m = estimates.front().along_m;
  double highest = -1;
  for (const PositionEstimate& centre : estimates) {
    double votes = 0;
    for (const PositionEstimate& estimate : estimates) {
      votes += biweight(estimate.along_m - centre.along_m, width_m) /
               std::hypot(estimate.sigma_m, width_m);
    }
    if (votes > highest) {
      highest = votes;
      densest_m = centre.along_m;
    }
  }
  return densest_m;
}

// The weighted mean of the estimates that are trusted at a position.
struct TrustedMean {
  double along_m = 0;
  double weight = 0;      // sum of the weights, 1/m^2
  double square_m2 = 0;   // weighted mean of squared deviations from along_m
  double chi_square = 0;  // mean over trust of squared deviations in units of the estimates' sigmas
  int support = 0;        // estimates with a weight above 0
};

double trust_in(const PositionEstimate& estimate, double along_m, double cutoff) {
  return biweight(estimate.along_m - along_m, cutoff * estimate.sigma_m);
}

double weight_of(const PositionEstimate& estimate) {
  return 1 / (estimate.sigma_m * estimate.sigma_m);
}

TrustedMean trusted_mean_about(const std::vector<PositionEstimate>& estimates, double along_m,
                               double cutoff) {
  TrustedMean mean;
  double sum = 0;
  double trusts = 0;
  for (const PositionEstimate& estimate : estimates) {
    const double trust = trust_in(estimate, along_m, cutoff);
    if (trust <= 0) continue;
    sum += trust * weight_of(estimate) * estimate.along_m;
    mean.weight += trust * weight_of(estimate);
    trusts += trust;
    ++mean.support;
  }
  if (mean.support == 0) return mean;
  mean.along_m = sum / mean.weight;
  for (const PositionEstimate& estimate : estimates) {
    const double off_m = estimate.along_m - mean.along_m;
    const double weighed =
        trust_in(estimate, along_m, cutoff) * weight_of(estimate) * off_m * off_m;
    mean.square_m2 += weighed / mean.weight;
    mean.chi_square += weighed / trusts;
  }
  return mean;
}

}  // namespace

std::optional<Measurement> combine_robustly(const std::vector<PositionEstimate>& estimates,
                                            const RobustSettings& settings) {
  if (static_cast<int>(estimates.size()) < settings.min_support) return std::nullopt;
  double along_m = densest_along_m(estimates, settings.vote_width_m);
  TrustedMean mean;
  for (int i = 0; i < settings.max_iterations; ++i) {
    mean = trusted_mean_about(estimates, along_m, settings.cutoff);
    if (mean.support < settings.min_support) return std::nullopt;
    const double moved_m = std::abs(mean.along_m - along_m);
    along_m = mean.along_m;
    if (moved_m < 1e-4) break;
  }
  // The actual spread of the inliers relative to their sigmas.
  const double inflation = std::max(1.0, std::sqrt(mean.chi_square));
  const double own_sigma_m = inflation / std::sqrt(mean.weight);
  const double shared_sigma_m = settings.shared_part * std::sqrt(mean.square_m2);
  return Measurement{along_m, std::hypot(own_sigma_m, shared_sigma_m), mean.support,
                     shared_sigma_m};
}

}  // namespace milepost
