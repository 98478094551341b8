// All that is found in one recorded drive before it is mapped, within seconds.
#pragma once

#include <vector>

#include "mapper/findings/finding.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// In the order of the checks; the same for any number of threads. Safe to call from several threads
// at once. Errors: those of FrameReader::gray.
Result<std::vector<Finding>> drive_findings(const Drive& drive);

// Of all drives, in their order, on `threads` >= 1 threads.
Result<std::vector<Finding>> drive_findings(const std::vector<Drive>& drives, int threads);

}  // namespace milepost
