// How far the clock of a recording's images is off that of its trajectory, by their motion.
#pragma once

#include <vector>

#include "mapper/geodata/trajectory.h"
#include "mapper/import/recording.h"
#include "schema/base/result.h"
#include "schema/geo/camera.h"

namespace milepost {

struct ClockOffset {
  double offset_s = 0;     // to be added to the images' times
  double correlation = 0;  // of what is seen with what was driven, at most 1
  bool by_turns = true;    // false: by stops and starts, of a drive that hardly turns
};

// Compares how far images turn from one to the next with how far the vehicle did, for offsets
// from -range_s to range_s. `headings` may be recorded apart from the positions. REQUIRES: images
// are files, in the order of their times. Errors: invalid_input, if the motion does not tell the
// offset; those of reading an image.
Result<ClockOffset> estimate_clock_offset(const std::vector<RecordedImage>& images,
                                          const Trajectory& positions, const Trajectory& headings,
                                          const Camera& camera, double range_s);

}  // namespace milepost
