// The areas that the plans of a found drive show.
#pragma once

#include "client/evaluate/report/find_report_figures.h"
#include "client/evaluate/report/report_plan.h"

namespace milepost {

// All walls and the recorded path.
PlanArea whole_area(const FoundSeries& series);
// The recorded path and where the vehicle was tracked; the whole area where neither is known.
PlanArea path_area(const FoundSeries& series);
// A street's width and some more about the densest place of a frame; nothing where it would leave
// out a tenth of the particles, or the recorded position.
std::optional<PlanArea> close_up_area(const FoundSeries& series, const FindSnapshot& snapshot);
// Whatever one of these shows.
Bounds shown_bounds(const FoundSeries& series);

}  // namespace milepost
