// What the recorded headings say against the way that the positions took.
#pragma once

#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/findings/steps.h"
#include "schema/drive/drive.h"

namespace milepost {

// Kinds: heading_noise, heading_offset, reversed_camera, exchanged_axes, mirrored_axis,
// heading_in_radians. REQUIRES: `steps` are the drive's.
std::vector<Finding> heading_findings(const Drive& drive, const std::vector<Step>& steps);

}  // namespace milepost
