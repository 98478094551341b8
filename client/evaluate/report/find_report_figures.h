// The figures of the report of a found drive.
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/find_errors.h"
#include "client/evaluate/report/find_report.h"
#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/report_page.h"

namespace milepost {

// What the figures draw, computed once.
struct FoundSeries {
  const FindReportInput* input = nullptr;
  std::vector<FindSnapshot> snapshots;
  std::vector<FindError> errors;  // one a frame
  FindSummary summary;
  std::vector<double> time_s;         // since the first frame
  std::vector<plot::Point> recorded;  // one a frame, metres about the recorder's origin
  std::vector<plot::Point> found;     // the same
};

// The input must outlive it.
FoundSeries found_series(const FindReportInput& input);

// The id of the element that all plans lie on, and the element (find_report_ground.cc), once in a
// document.
inline constexpr const char* kPlanGround = "ground";
std::string plan_ground(const FoundSeries& series);

// In plan view (find_report_plans.cc).
std::string plan_legend();
// One a snapshot.
std::vector<Figure> snapshot_figures(const FoundSeries& series);
Figure path_figure(const FoundSeries& series);

// Over time (find_report_curves.cc).
Figure position_error_figure(const FoundSeries& series);
Figure heading_error_figure(const FoundSeries& series);
Figure belief_figure(const FoundSeries& series);

}  // namespace milepost
