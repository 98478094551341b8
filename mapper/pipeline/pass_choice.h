// Chooses, of several passes of a road, the one whose line and landmarks its segment takes.
#pragma once

#include <vector>

#include "mapper/network/road_network.h"
#include "mapper/pipeline/pass_frames.h"
#include "mapper/pipeline/settings.h"

namespace milepost {

// `keep-best`: the pass with most features in its frames, of some frames of each; of about equal
// ones that with the closest frames. `replace`: that of the drive captured last. Of equal ones the
// first by the drive's name. Does not depend on the order in which drives were given. Not safe to
// use from several threads at once.
class PassChoice {
 public:
  // REQUIRES: the frames outlive it. The error of a frame that cannot be read is theirs to tell.
  PassChoice(PassFrames& frames, const BuildSettings& settings)
      : frames_(frames), settings_(settings) {}

  // An index into `passes`, which are sorted by the drive's name.
  std::size_t best(const std::vector<Pass>& passes);

 private:
  struct Quality {
    double features = 0;  // a frame
    double spacing_m = 0;
  };

  Quality quality_of(const Pass& pass);
  std::size_t latest(const std::vector<Pass>& passes) const;
  std::size_t richest(const std::vector<Pass>& passes);

  PassFrames& frames_;
  const BuildSettings& settings_;
};

}  // namespace milepost
