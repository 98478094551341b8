// The particle filter of the aerial paper, section IV, as it stands there: particles weighed frame
// by frame by the orientations of walls alone.
#pragma once

#include "client/global/plan_filter.h"

namespace milepost {

FindMethod orientations_method();

}  // namespace milepost
