// Position estimates from single tracklets, and their combination into a measurement.
// The tracklet paper, section 3.1.3, Eqs 3 to 6.
#pragma once

#include <optional>
#include <vector>

#include "schema/base/range.h"

namespace milepost {

// What one matched tracklet says of the capture position (Eq. 3).
struct PositionEstimate {
  double along_m = 0;
  double sigma_m = 0;  // > 0; from the tracklet's residuals and the noise of the query's scale
};

// A Gaussian over along: the measurement PDF of Eq. 6.
struct Measurement {
  double along_m = 0;
  double sigma_m = 0;  // > 0
  int support = 0;     // estimates that agree with it
  // The part of sigma_m that neither more estimates nor more frames average out: a facade seen from
  // another lateral position or heading misleads all features on it alike.
  double shared_sigma_m = 0;
};

// What one tracklet said of a frame that was followed, for those who study estimates.
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
  int min_support = 3;        // fewer agreeing estimates are no measurement
  double shared_part = 0.25;  // of the estimates' spread is an error that they share
};

// Ours: the densest position of all estimates, then a weighted mean around it in which an estimate
// counts by its own sigma and not at all beyond the cutoff. Nothing without enough support.
std::optional<Measurement> combine_robustly(const std::vector<PositionEstimate>& estimates,
                                            const RobustSettings& settings);

}  // namespace milepost
