// Vanishing directions as the aerial paper finds them (section III): subtractive clustering of
// where lines meet on the Gaussian sphere, lines classed by their arc distance.
#pragma once

#include "client/global/vanishing_directions.h"

namespace milepost {

// Like vanishing_directions(), whose evidence it takes the place of.
VanishingDirections clustered_vanishing_directions(std::span<const LineSegment> segments,
                                                   const Pinhole& view,
                                                   const VanishingSettings& settings = {});
VanishingDirections clustered_vanishing_directions(const cv::Mat& gray, const Pinhole& view,
                                                   const VanishingSettings& settings = {});

}  // namespace milepost
