// Whether two passes that lie in one place on the map show the same road.
#pragma once

#include <optional>

#include "mapper/network/road_network.h"
#include "mapper/pipeline/pass_frames.h"
#include "mapper/pipeline/settings.h"

namespace milepost {

// Compares frames taken in the same place: of one road they have matches that agree with one
// epipolar geometry. Does not depend on the order in which drives were given. Not safe to use from
// several threads at once.
class PassComparison {
 public:
  // REQUIRES: the frames outlive it. The error of a frame that cannot be read is theirs to tell.
  PassComparison(PassFrames& frames, const BuildSettings& settings)
      : frames_(frames), settings_(settings) {}

  // True if most pairs of frames match, false if none of three or more does, nothing if they do not
  // tell. In very different light one road may look like two.
  std::optional<bool> show_the_same_road(const Pass& a, const Pass& b);

 private:
  PassFrames& frames_;
  const BuildSettings& settings_;
};

}  // namespace milepost
