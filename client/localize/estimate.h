// Arc length estimates from single tracklets and their combination into a measurement. The tracklet
// paper, section 3.1.3, Eqs 3 to 6.
#pragma once

#include <optional>
#include <vector>

#include "schema/base/range.h"

namespace milepost {

// The capture position estimated from one matched tracklet (Eq. 3).
struct PositionEstimate {
  double along_m = 0;
  double sigma_m = 0;  // > 0; from the tracklet's residuals and the noise of the query's scale
};

// A Gaussian over arc length: the measurement PDF of Eq. 6.
struct Measurement {
  double along_m = 0;
  double sigma_m = 0;  // > 0
  int support = 0;     // number of inlier estimates
  // The part of sigma_m that is not averaged out by more estimates or frames: a facade seen from
  // another lateral offset or heading biases all features on it alike.
  double shared_sigma_m = 0;
};

// The estimate of one tracklet in a tracked frame, for studies of the estimates.
struct TrackletEstimate {
  PositionEstimate estimate;
  double scale_px = 0;   // of the matched feature, as the map's camera would see it
  AlongRange along;      // of the tracklet
  double r_squared = 0;  // of its regression
};

struct RobustSettings {
  double vote_width_m = 1.0;  // half width of the kernel that finds the densest position
  double cutoff = 3.0;        // of Tukey's biweight, in units of an estimate's own sigma
  int max_iterations = 20;
  int min_support = 3;        // fewer inliers give no measurement
  double shared_part = 0.25;  // the part of the estimates' spread that is a shared error
};

// Ours: the mode of all estimates, then an iteratively reweighted mean around it in which an
// estimate counts by its own sigma, and not beyond the cutoff. None without enough support.
std::optional<Measurement> combine_robustly(const std::vector<PositionEstimate>& estimates,
                                            const RobustSettings& settings);

}  // namespace milepost
