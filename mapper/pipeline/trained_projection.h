// Trains the codebook of a map (a PCA projection) on frames spread evenly over all of its road.
#pragma once

#include <vector>

#include "mapper/pipeline/settings.h"
#include "mapper/pipeline/stretch_plan.h"
#include "schema/feature/pca_projection.h"

namespace milepost {

// Errors: those of FrameReader::gray.
Result<PcaProjection> trained_projection(const std::vector<Drive>& drives,
                                         const std::vector<StretchPlan>& plans,
                                         const BuildSettings& settings, int jobs);

}  // namespace milepost
