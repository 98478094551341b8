// A frame of the mapping drive, for the methods that match whole frames.
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
  FeatureSet features;                   // empty in a layer that stores none
  std::optional<ImageDescriptor> image;  // nothing in a layer that stores none
};

// The frames that were captured in [index, index + 1) * tile length of one segment, by arc length.
// Either all of them have an image descriptor or none.
struct ImageDescriptorTile {
  std::string segment;
  std::uint32_t index = 0;
  std::vector<DatabaseFrame> frames;
};

}  // namespace milepost
