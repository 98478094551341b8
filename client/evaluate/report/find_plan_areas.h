// The areas shown by the plans of a global localization report.
#pragma once

#include "client/evaluate/report/find_report_figures.h"
#include "schema/page/report_plan.h"

namespace milepost {

// All walls and the recorded path.
PlanArea whole_area(const FoundSeries& series);
// The recorded path and the tracked positions; the whole area if neither is known.
PlanArea path_area(const FoundSeries& series);
// An area somewhat wider than a street around the densest mode of a frame; none if it would omit a
// tenth of the particles, or the recorded position.
std::optional<PlanArea> close_up_area(const FoundSeries& series, const FindSnapshot& snapshot);
// The area that any of these shows.
Bounds shown_bounds(const FoundSeries& series);

}  // namespace milepost
