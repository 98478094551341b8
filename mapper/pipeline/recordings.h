// Which drives are recordings of one run of one vehicle, and what all drives say of their errors.
#pragma once

#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/fusion/slow_errors.h"
#include "mapper/pipeline/build_plan.h"
#include "schema/drive/drive.h"

namespace milepost {

// The drives without those whose frames another one has: the same images at the same times and
// places. Of two equal drives the one of the first name stays. Adds a finding for each that goes.
// REQUIRES: drives by name.
std::vector<const Drive*> without_copies(const std::vector<const Drive*>& drives,
                                         std::vector<Finding>& findings);

// What the plan's drives state of their errors, and which are bound to be the same: those of drives
// that name one group, and of cameras on one vehicle, which are in nearly one place at each time.
struct RecordedErrors {
  std::vector<DriveErrors> drives;       // of the plan
  std::vector<DrivenStretch> stretches;  // of all its drives, in the order of the plan
};
RecordedErrors recorded_errors(const BuildPlan& plan, const SlowErrorSettings& settings);

}  // namespace milepost
