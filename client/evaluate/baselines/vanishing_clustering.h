// Vanishing directions by the method of the aerial paper (section III): subtractive clustering of
// line intersections on the Gaussian sphere; lines are assigned by arc distance.
#pragma once

#include "client/global/vanishing_directions.h"

namespace milepost {

// Like vanishing_directions(), with clustering instead of likelihoods.
VanishingDirections clustered_vanishing_directions(std::span<const LineSegment> segments,
                                                   const Pinhole& view,
                                                   const VanishingSettings& settings = {});
VanishingDirections clustered_vanishing_directions(const cv::Mat& gray, const Camera& camera,
                                                   const VanishingSettings& settings = {});

}  // namespace milepost
