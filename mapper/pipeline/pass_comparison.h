// Whether two passes that lie in one place on the map show the same road.
#pragma once

#include <optional>
#include <vector>

#include "mapper/network/driven_line.h"
#include "mapper/network/road_network.h"
#include "mapper/pipeline/settings.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// Compares frames taken in the same place: of one road they have matches that agree with one
// epipolar geometry. Does not depend on the order in which drives were given. Not safe to use from
// several threads at once.
class PassComparison {
 public:
  // REQUIRES: drives, sorted by name, and their lines outlive it.
  PassComparison(const std::vector<const Drive*>& drives,
                 const std::vector<NamedDrivenLines>& lines, const BuildSettings& settings,
                 int jobs)
      : drives_(drives), lines_(lines), settings_(settings), jobs_(jobs) {}

  // True if most pairs of frames match, false if none of three or more does, nothing if they do not
  // tell. In very different light one road may look like two.
  std::optional<bool> show_the_same_road(const Pass& a, const Pass& b);

  // The first error of a frame: one of FrameReader::gray.
  const std::optional<Error>& failure() const { return failure_; }

 private:
  const std::vector<const Drive*>& drives_;
  const std::vector<NamedDrivenLines>& lines_;
  const BuildSettings& settings_;
  int jobs_;
  std::optional<Error> failure_;
};

}  // namespace milepost
