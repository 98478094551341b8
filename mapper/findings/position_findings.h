// What is wrong with recorded positions, by themselves and against the receiver's.
#pragma once

#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/findings/steps.h"
#include "schema/drive/drive.h"

namespace milepost {

// Kinds: null_island, rounded_positions, repeated_positions, position_noise, altitude_noise,
// altitude_jump, sparse_frames, standstill, receiver_apart. REQUIRES: `steps` are the drive's.
std::vector<Finding> position_findings(const Drive& drive, const std::vector<Step>& steps);

}  // namespace milepost
