// Chooses, of several passes of a road, the one whose line and landmarks its segment takes.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "mapper/network/driven_line.h"
#include "mapper/network/road_network.h"
#include "mapper/pipeline/settings.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// `keep-best`: the pass with most features in its frames, of some frames of each; of about equal
// ones that with the closest frames. `replace`: that of the drive captured last. Of equal ones the
// first by the drive's name. Does not depend on the order in which drives were given. Not safe to
// use from several threads at once.
class PassChoice {
 public:
  // REQUIRES: drives, sorted by name, and their lines outlive it.
  PassChoice(const std::vector<const Drive*>& drives, const std::vector<NamedDrivenLines>& lines,
             const BuildSettings& settings, int jobs);

  // An index into `passes`, which are sorted by the drive's name.
  std::size_t best(const std::vector<Pass>& passes);

  // The first error of a frame: one of FrameReader::gray.
  const std::optional<Error>& failure() const { return failure_; }

 private:
  struct Quality {
    double features = 0;  // a frame
    double spacing_m = 0;
  };

  Quality quality_of(const Pass& pass);
  std::size_t latest(const std::vector<Pass>& passes) const;
  std::size_t richest(const std::vector<Pass>& passes);

  const std::vector<const Drive*>& drives_;
  const std::vector<NamedDrivenLines>& lines_;
  const BuildSettings& settings_;
  int jobs_;
  std::optional<Error> failure_;
};

}  // namespace milepost
