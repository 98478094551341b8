// The input of a localizer from the query camera.
#pragma once

#include <functional>

#include "schema/feature/types.h"

namespace milepost {

// One frame of the query camera. Its features are requested once the map, and with it the
// extractor's parameters, is known; the returned reference is used during localize() only. Methods
// that compare whole images request the descriptor of schema/feature/wisurf.h and find nothing
// without it; others never do.
struct QueryFrame {
  double timestamp_s = 0;
  std::function<const FeatureSet&(const FeatureParameters&)> features;
  std::function<const ImageDescriptor&()> image = {};
};

}  // namespace milepost
