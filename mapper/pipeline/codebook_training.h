// Trains a codebook on recorded drives.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mapper/pipeline/build_plan.h"
#include "mapper/pipeline/settings.h"
#include "schema/feature/pca_projection.h"

namespace milepost {

// Trained on `frames` frames, spread evenly over all drives. `version` is an id. Errors: those of
// FrameReader::gray.
Result<PcaProjection> trained_codebook(const std::vector<DrivePlan>& drives,
                                       const BuildSettings& settings, std::size_t frames,
                                       const std::string& version, int jobs);

}  // namespace milepost
