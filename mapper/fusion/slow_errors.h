// The slow errors of drives' poses: a bias of each drive and a drift along its way, as far as the
// drives differ where they share a road. A sparse least-squares problem with an
// Ornstein-Uhlenbeck prior, solved with robust weights; the variances of the prior are estimated,
// too (variance components, by expectation maximization), so that a drive which differs from all
// others counts for less.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/fusion/tie.h"
#include "schema/base/range.h"

namespace milepost {

struct SlowErrorSettings {
  double node_spacing_m = 20;  // of the estimates along a stretch
  double correlation_m = 200;  // of the drift
  double bias_sigma_m = 0.1;   // on each axis; where the estimate of the variances begins, what ...
  double drift_sigma_m = 0.15;  // ... holds for drives that meet no other, and how a stated sigma
                                // is divided
  double min_sigma_m = 0.003;   // below which no standard deviation is estimated
  double bias_roll_sigma_rad = 0.02;  // the same of roll
  double drift_roll_sigma_rad = 0.02;
  double min_roll_sigma_rad = 0.0003;
};

// What is known beforehand of the errors of a drive's positions.
struct DriveErrors {
  std::size_t bias = 0;                // drives of one number have one bias
  std::optional<double> sigma_m = {};  // stated, of bias and drift together, on each axis
  bool sigma_is_assumed = false;       // not stated: the usual one and what is known beside it
  std::optional<double> correlation_m = {};  // stated, of the drift
};

// A stretch that was driven without a pause.
struct DrivenStretch {
  // The same way of the same vehicle on another stretch: their errors are one.
  struct SameWay {
    std::size_t stretch = 0;
    AlongRange along;  // of this stretch ...
    AlongRange there;  // ... and of the other one
  };

  std::size_t drive = 0;
  double length_m = 0;
  // What the drive's sigma is multiplied by, one value for each node; empty: 1 everywhere.
  std::vector<double> sigma_factors = {};
  std::optional<SameWay> same_way = {};
};

// Estimates for each stretch.
class SlowErrors {
 public:
  struct Node {
    ErrorVector error = ErrorVector::Zero();
    ErrorVector variance = ErrorVector::Zero();  // of what is left after a correction
  };

  struct OfStretch {
    std::vector<Node> nodes;  // `spacing_m` apart
    bool is_assumed = false;
  };

  SlowErrors(std::vector<OfStretch> stretches, double spacing_m)
      : stretches_(std::move(stretches)), spacing_m_(spacing_m) {}

  // REQUIRES: `stretch` is one of those given; `along_m` is clamped to its length.
  PoseError error(std::size_t stretch, double along_m) const;
  // The standard deviation in plan, the mean of both axes, of positions after the correction.
  double sigma_m(std::size_t stretch, double along_m) const;
  // Whether that is what the settings say: the drive states nothing, and no tie between different
  // biases tells it.
  bool is_assumed(std::size_t stretch) const { return stretches_[stretch].is_assumed; }
  // Both as they were estimated, between nodes linearly.
  Node at(std::size_t stretch, double along_m) const;

 private:
  std::vector<OfStretch> stretches_;
  double spacing_m_;
};

// The number of a stretch's nodes.
std::size_t node_count(double length_m, const SlowErrorSettings& settings);

// What a drive states is believed unless the drives differ by more. REQUIRES: stretches are of
// these drives, ties of these stretches; drives of stretches of one way have one bias, and the
// stretch that another names as its way names none. Stretches that neither ties nor a bias connect
// do not affect each other.
SlowErrors estimate_slow_errors(const std::vector<DriveErrors>& drives,
                                const std::vector<DrivenStretch>& stretches,
                                const std::vector<Tie>& ties, const SlowErrorSettings& settings);

}  // namespace milepost
