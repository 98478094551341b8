// Systematic resampling of weighed particles.
#pragma once

#include <cstddef>
#include <random>

namespace milepost {

// Calls take(i) `count` times, each particle as often as its part of the weights says, to one more
// or less: one draw places a comb of `count` equal teeth over the summed weights.
// REQUIRES: particles > 0; weight_of(i) of each is not negative, and they sum up to `total` > 0.
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
