// What a drive's images say against its table.
#pragma once

#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/findings/steps.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// Kinds: repeated_images, clock_offset. Reads up to 240 images, where the drive turns most.
// REQUIRES: `steps` are the drive's. Errors: those of FrameReader::gray.
Result<std::vector<Finding>> image_findings(const Drive& drive, const std::vector<Step>& steps);

}  // namespace milepost
