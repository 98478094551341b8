// The landmarks of all drives become the tiles of the default method's layer.
#pragma once

#include <functional>

#include "mapper/fusion/landmark_store.h"
#include "mapper/pipeline/build_plan.h"
#include "mapper/pipeline/layer_builder.h"
#include "mapper/pipeline/settings.h"

namespace milepost {

struct FusedResult {
  std::vector<PositionError> left;  // how well each of the plan's segments is known
  SlowErrors errors;                // by which the landmarks were moved; stretches as in the plan
};

// Estimates how far the drives' positions are off where they passed one road together, moves their
// landmarks by that, and makes those of one feature one. Passes each tile that holds anything to
// `use`, each segment's ascending.
// Errors: those of the store and of `use`; invalid_input for a tile that holds more than the format
// allows.
Result<FusedResult> build_fused_tiles(const BuildPlan& plan, LandmarkStore& store,
                                      const PcaProjection& projection,
                                      const BuildSettings& settings,
                                      const std::function<Status(const BuiltTile&)>& use);

}  // namespace milepost
