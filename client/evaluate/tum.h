// Trajectories in the text form of TUM's RGB-D benchmark, which the field's evaluators read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/evaluate/replay.h"
#include "schema/base/output_file.h"
#include "schema/drive/drive.h"

namespace milepost {

extern const OutputKind kTumOutput;

// "timestamp tx ty tz qx qy qz qw" for each frame with a pose in six degrees of freedom: the camera
// (x right, y down, z forward) in the drive's tangent frame, or that of its first frame (east,
// north, up).
std::string tum_text(const std::vector<FrameFix>& fixes, const Drive& drive);
// The recorded poses, in the same frame.
std::string tum_truth_text(const Drive& drive);

// Where evaluate writes the recorded poses: run.tum -> run-truth.tum.
std::filesystem::path tum_truth_file(const std::filesystem::path& file);

}  // namespace milepost
