// The frames of passes, looked at before the map is planned.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/network/driven_line.h"
#include "mapper/network/road_network.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/feature/types.h"

namespace milepost {

// At most `count` of the frames, at equal intervals.
std::vector<std::size_t> spread_evenly(const std::vector<std::size_t>& frames, std::size_t count);

// Not safe to use from several threads at once.
class PassFrames {
 public:
  // REQUIRES: drives, sorted by name, and their lines outlive it.
  PassFrames(const std::vector<const Drive*>& drives, const std::vector<NamedDrivenLines>& lines,
             int jobs)
      : drives_(drives), lines_(lines), jobs_(jobs) {}

  const Drive& drive_of(const Pass& pass) const { return *drives_[pass.drive]; }
  // Indices of the drive's frames on a pass; of a pass between two frames the nearest one.
  std::vector<std::size_t> on(const Pass& pass) const;
  // The features of some frames of the pass's drive; none if one cannot be read.
  std::optional<std::vector<FeatureSet>> features(const Pass& pass,
                                                  const std::vector<std::size_t>& frames,
                                                  const FeatureParameters& parameters);

  // The first error of a frame: one of FrameReader::gray.
  const std::optional<Error>& failure() const { return failure_; }

 private:
  const std::vector<const Drive*>& drives_;
  const std::vector<NamedDrivenLines>& lines_;
  int jobs_;
  std::optional<Error> failure_;
};

}  // namespace milepost
