// The frames of a pass.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/network/driven_line.h"
#include "mapper/network/road_network.h"

namespace milepost {

// Indices of the drive's frames on a pass; of a pass between two frames the nearest one.
std::vector<std::size_t> frames_on(const Pass& pass, const DrivenLine& driven);

// At most `count` of the frames, at equal intervals.
std::vector<std::size_t> spread_evenly(const std::vector<std::size_t>& frames, std::size_t count);

}  // namespace milepost
