// The figures of a global localization report.
#pragma once

#include <vector>

#include "client/evaluate/find_errors.h"
#include "client/evaluate/report/find_report_data.h"
#include "schema/page/report_plan.h"

namespace milepost {

// The data of the figures, computed once.
struct FoundSeries {
  const FindReportInput* input = nullptr;
  std::vector<FindSnapshot> snapshots;
  std::vector<FindError> errors;  // one per frame
  FindSummary summary;
  std::vector<double> time_s;       // since the first frame
  std::vector<PlanPoint> recorded;  // one per frame, metres relative to the recorder's origin
  std::vector<PlanPoint> found;     // the same
};

// REQUIRES: the input outlives the result.
FoundSeries found_series(const FindReportInput& input);

// In plan view (find_report_plans.cc).
// The legend of all snapshots, as layers without data.
Json plan_keys();
// One per snapshot.
std::vector<Figure> snapshot_figures(const FoundSeries& series);
Figure path_figure(const FoundSeries& series);
// Adds the walls to the page's columns, and the background image.
void add_ground(Json& page, const FoundSeries& series);

// Over time (find_report_curves.cc).
Figure position_error_figure(const FoundSeries& series);
Figure heading_error_figure(const FoundSeries& series);
Figure belief_figure(const FoundSeries& series);
// Adds the page's columns and `frames`, which defines the readout of a frame.
void add_frames(Json& page, const FoundSeries& series);

}  // namespace milepost
