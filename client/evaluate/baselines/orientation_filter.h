// The particle filter of the aerial paper, section IV, as published: particles are weighted frame
// by frame by the orientations of walls alone.
#pragma once

#include "client/global/plan_filter.h"

namespace milepost {

GlobalMethod orientations_method();

}  // namespace milepost
