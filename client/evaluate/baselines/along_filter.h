// The Bayes estimators of the paper's tracker: how a belief about along is carried and updated.
// The tracklet paper, sections 3.2, 3.3 and 5.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "client/evaluate/baselines/kalman.h"
#include "client/localize/estimate.h"

namespace milepost {

// Keeps a belief between the two halves of a frame: prediction (Eq. 7), then update (Eq. 8).
// Not safe to use from several threads.
class AlongFilter {
 public:
  virtual ~AlongFilter() = default;

  virtual void reset(const AlongBelief& belief) = 0;
  // Moves by `step_m` (Eq. 16) with the transition noise of Eq. 17.
  virtual void predict(double step_m, double sigma_w_m) = 0;
  // Takes in the measurement PDF of Eq. 6; `variance_weight` multiplies its variance (section
  // 4.2.3).
  virtual void update(const Measurement& measurement, double variance_weight) = 0;
  virtual AlongBelief belief() const = 0;
};

// Eqs 9 to 11.
std::unique_ptr<AlongFilter> make_kalman_filter();

// Sampling Importance Resampling, section 5.4: particles move by draws from Eq. 17, weigh by the
// measurement PDF of Eq. 6, and are drawn anew by their weights. The belief is the weighed
// particles' mean and variance, taken before resampling adds its own noise.
// REQUIRES: particles > 0. The same seed gives the same beliefs.
std::unique_ptr<AlongFilter> make_particle_filter(std::size_t particles, std::uint64_t seed);

}  // namespace milepost
