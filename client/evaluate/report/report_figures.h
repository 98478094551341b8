// The figures of the report. Each is valid even without data to draw.
#pragma once

#include "client/evaluate/report/report_series.h"
#include "schema/page/report_json.h"

namespace milepost {

// Along the route (report_route.cc). REQUIRES: there is a method.
Figure error_figure(const ReportSeries& series);
Figure lateral_figure(const ReportSeries& all);  // of the methods that estimate a lateral offset
Figure matches_figure(const ReportSeries& series);
Figure latency_figure(const ReportSeries& series);

// Error distributions (report_spread.cc). REQUIRES: there is a method.
Figure histogram_figure(const ReportSeries& series);
Figure cumulative_figure(const ReportSeries& series);

// In plan view (report_map.cc). REQUIRES: there is a method.
Figure map_figure(const ReportInput& input, const ReportSeries& series);
// Adds the recorded position of each frame to the page's columns, and to its `frames`.
void add_places(Json& page, const ReportInput& input);

// Frame by frame (report_frames.cc): adds the page's columns and `frames`, which defines the
// readout of a frame. REQUIRES: there is a method.
void add_frames(Json& page, const ReportSeries& series);

}  // namespace milepost
