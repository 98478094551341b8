// What a localizer is given of the query camera.
#pragma once

#include <functional>

#include "schema/feature/types.h"

namespace milepost {

// One frame of the query camera. Its features are asked for once the map, and with it the
// parameters of the extractor, is known; the reference is used during localize() only. Methods that
// compare whole images ask for the descriptor of schema/feature/wisurf.h and find nothing without
// it; others never ask.
struct QueryFrame {
  double timestamp_s = 0;
  std::function<const FeatureSet&(const FeatureParameters&)> features;
  std::function<const ImageDescriptor&()> image = {};
};

}  // namespace milepost
