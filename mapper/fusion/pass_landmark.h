// A landmark of one drive on a segment that others may have passed, too.
#pragma once

#include <cstddef>

#include "mapper/landmarks/landmark_mapper.h"

namespace milepost {

struct PassLandmark {
  MappedLandmark landmark;  // its range is in the segment's arc length
  std::size_t pass = 0;     // index of the segment's passes
  double stretch_m = 0;     // the middle of its observations along the drive's stretch
};

}  // namespace milepost
