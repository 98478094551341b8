// The paper's Bayes estimator as functions from old to new belief: they hold no state.
// The tracklet paper, sections 3.2, 3.3 and 4.2.1, Eqs 7 to 11, 16 and 17.
#pragma once

#include <Eigen/Core>

#include "client/localize/estimate.h"

namespace milepost {

// A Gaussian belief over arc length.
struct AlongBelief {
  double along_m = 0;
  double variance_m2 = 0;
};

// The step of the constant velocity model from the positions of the last two frames, Eq. 16.
// REQUIRES: before_s < latest_s < now_s.
double constant_velocity_step_m(double before_m, double before_s, double latest_m, double latest_s,
                                double now_s);

// The prediction of Eq. 9 (of Eq. 7 for Gaussians; the transition is Eq. 17).
AlongBelief predict(const AlongBelief& belief, double step_m, double sigma_w_m);

// The update of Eqs 10 and 11 (of Eq. 8 for Gaussians). `variance_weight` multiplies the
// measurement's variance: below 1 trusts it more, above 1 less (section 4.2.3).
AlongBelief update(const AlongBelief& predicted, const Measurement& measurement,
                   double variance_weight);

// A Gaussian with mean x and covariance P over arc length (m) and speed (m/s): ours.
struct MotionBelief {
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  Eigen::Matrix2d P = Eigen::Matrix2d::Identity();
};

// Constant speed disturbed by white acceleration noise of `acceleration_sigma` (m/s^2 / sqrt(Hz)).
// REQUIRES: dt_s >= 0.
MotionBelief predict(const MotionBelief& belief, double dt_s, double acceleration_sigma);

// The update with a measurement of arc length, in Joseph form, which keeps P positive definite.
MotionBelief update(const MotionBelief& predicted, const Measurement& measurement);

}  // namespace milepost
