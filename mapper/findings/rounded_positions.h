// Positions that were recorded with too few digits.
#pragma once

#include "schema/drive/drive.h"

namespace milepost {

// The step to which all of a drive's positions are rounded, in metres: one digit of decimal degrees
// or metres, as they are given; 0 if it is below 0.05 m, or if the drive has too few places to
// tell.
double rounding_step_m(const Drive& drive);

}  // namespace milepost
