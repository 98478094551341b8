// A frame of the mapping drive, as the methods that match whole frames need it.
// The tracklet paper, section 5.2, comparative methods 1 and 2.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schema/feature/types.h"

namespace milepost {

struct DatabaseFrame {
  double along_m = 0;                    // capture position
  FeatureSet features;                   // empty in a layer that keeps none
  std::optional<ImageDescriptor> image;  // nothing in a layer that keeps none
};

// The frames that were captured in [index, index + 1) * tile length of one segment, by along.
// Either all of them have an image descriptor or none.
struct FrameTile {
  std::string segment;
  std::uint32_t index = 0;
  std::vector<DatabaseFrame> frames;
};

}  // namespace milepost
