// The Bayes filters of the paper's tracker: prediction and update of a belief over arc length. The
// tracklet paper, sections 3.2, 3.3 and 5.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "client/evaluate/baselines/kalman.h"
#include "client/localize/estimate.h"

namespace milepost {

// Alternates prediction (Eq. 7) and update (Eq. 8) of a belief. Not safe to use from several
// threads at once.
class AlongFilter {
 public:
  virtual ~AlongFilter() = default;

  virtual std::unique_ptr<AlongFilter> clone() const = 0;
  virtual void reset(const AlongBelief& belief) = 0;
  // Predicts by `step_m` (Eq. 16) with the transition noise of Eq. 17.
  virtual void predict(double step_m, double sigma_w_m) = 0;
  // Updates with the measurement PDF of Eq. 6; `variance_weight` multiplies its variance (section
  // 4.2.3).
  virtual void update(const Measurement& measurement, double variance_weight) = 0;
  virtual AlongBelief belief() const = 0;
};

// Eqs 9 to 11.
std::unique_ptr<AlongFilter> make_kalman_filter();

// Sampling importance resampling, section 5.4: particles move by draws from Eq. 17, are weighted
// with the measurement PDF of Eq. 6 and resampled. The belief is the mean and variance of the
// weighted particles, before resampling adds noise. REQUIRES: particles > 0. The same seed gives
// the same beliefs.
std::unique_ptr<AlongFilter> make_particle_filter(std::size_t particles, std::uint64_t seed);

}  // namespace milepost
