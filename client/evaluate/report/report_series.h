// What the report draws: the numbers of an evaluation, one series a method.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/evaluate/report/report.h"

namespace milepost {

struct MethodSeries {
  std::string name;
  std::string css_class;  // "m0" to "m8": its colour
  const MethodEvaluation* evaluation = nullptr;
  // One a fix; NaN where unknown.
  std::vector<double> route_m;             // where on the route
  std::vector<double> error_m;             // signed
  std::vector<double> localized_errors_m;  // the known ones of error_m, ascending
  std::vector<double> lateral_error_m;     // signed
  std::vector<double> heading_error_deg;   // signed

  bool knows_lateral() const { return evaluation->summary.knows_lateral(); }
};

struct ReportSeries {
  std::vector<MethodSeries> methods;  // in the order of the input
  std::size_t chief = 0;              // the default method, or else the first
  std::string route_label;            // what route_m is, with its unit
  double route_from_m = 0;
  double route_to_m = 0;
  // Errors up to this much are drawn to scale, in either direction; some of a method's may be
  // beyond.
  double error_limit_m = 0;
  double lateral_limit_m = 0;  // the same of lateral errors

  bool knows_lateral() const;  // some method
  // REQUIRES: there is a method.
  const MethodSeries& chief_method() const { return methods[chief]; }
  // Order of drawing: the chief last, on top.
  std::vector<const MethodSeries*> back_to_front() const;
};

ReportSeries report_series(const ReportInput& input);

// The methods of which `shown` is true, with the scales of all; another chief where it is not.
ReportSeries only(const ReportSeries& all, const std::function<bool(const MethodSeries&)>& shown);

// One coloured name a method, as HTML.
std::string method_legend(const ReportSeries& series);

}  // namespace milepost
