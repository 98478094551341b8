// Systematic resampling of weighted particles.
#pragma once

#include <cstddef>
#include <random>

namespace milepost {

// Calls take(i) `count` times. Each particle i is taken in proportion to its weight, rounded up or
// down: one random number offsets a comb of `count` equidistant teeth over the cumulative weights.
// REQUIRES: particles > 0; all weight_of(i) >= 0, and their sum is `total` > 0.
template <class WeightOf, class Random, class Take>
void resample_systematically(std::size_t particles, const WeightOf& weight_of, double total,
                             std::size_t count, Random& random, const Take& take) {
  const double step = total / static_cast<double>(count);
  double tooth = std::uniform_real_distribution<double>(0, step)(random);
  double summed = weight_of(std::size_t{0});
  std::size_t i = 0;
  for (std::size_t taken = 0; taken < count; ++taken) {
    while (summed < tooth && i + 1 < particles) summed += weight_of(++i);
    take(i);
    tooth += step;
  }
}

}  // namespace milepost
