// The slow errors of drives' poses: a bias of each drive and a drift along its way, as far as the
// drives differ where they share a road. A sparse least-squares problem with an
// Ornstein-Uhlenbeck prior, solved with robust weights; the variances of the prior are estimated,
// too (variance components, by expectation maximization), so that a drive which differs from all
// others counts for less.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/fusion/tie.h"

namespace milepost {

struct SlowErrorSettings {
  double node_spacing_m = 20;   // of the estimates along a stretch
  double correlation_m = 200;   // of the drift
  double bias_sigma_m = 0.1;    // on each axis; where the estimate of the variances begins, ...
  double drift_sigma_m = 0.15;  // ... and what holds for drives that meet no other
  double min_sigma_m = 0.003;   // below which no standard deviation is estimated
  double bias_roll_sigma_rad = 0.02;  // the same of roll
  double drift_roll_sigma_rad = 0.02;
  double min_roll_sigma_rad = 0.0003;
};

// A stretch that was driven without a pause.
struct DrivenStretch {
  std::size_t drive = 0;
  double length_m = 0;
};

// Estimates for each stretch.
class SlowErrors {
 public:
  struct Node {
    ErrorVector error = ErrorVector::Zero();
    ErrorVector variance = ErrorVector::Zero();  // of what is left after a correction
  };

  SlowErrors(std::vector<std::vector<Node>> nodes, double spacing_m)
      : nodes_(std::move(nodes)), spacing_m_(spacing_m) {}

  // REQUIRES: `stretch` is one of those given; `along_m` is clamped to its length.
  PoseError error(std::size_t stretch, double along_m) const;
  // The standard deviation in plan, the mean of both axes, of positions after the correction.
  double sigma_m(std::size_t stretch, double along_m) const;

 private:
  Node at(std::size_t stretch, double along_m) const;

  std::vector<std::vector<Node>> nodes_;  // of each stretch, `spacing_m_` apart
  double spacing_m_;
};

// REQUIRES: ties are of these stretches. Stretches that no ties connect do not affect each other.
SlowErrors estimate_slow_errors(const std::vector<DrivenStretch>& stretches,
                                const std::vector<Tie>& ties, const SlowErrorSettings& settings);

}  // namespace milepost
