// The data of the report: the numbers of an evaluation, one series per method.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "client/evaluate/report/report_data.h"

namespace milepost {

struct MethodSeries {
  std::string name;
  std::string colour;      // "m0" to "m8"
  std::size_t number = 0;  // among the methods of the input
  const MethodEvaluation* evaluation = nullptr;
  // One value per fix; NaN if unknown.
  std::vector<double> error_m;             // signed, of the arc length
  std::vector<double> localized_errors_m;  // the known ones of error_m, ascending
  std::vector<double> lateral_error_m;     // signed, of the lateral offset
  std::vector<double> heading_error_deg;   // signed

  bool knows_lateral() const { return evaluation->summary.knows_lateral(); }
  // The name of a column of the page with the method's values.
  std::string column(const std::string& values) const {
    return std::to_string(number) + "." + values;
  }
};

struct ReportSeries {
  std::vector<MethodSeries> methods;  // in the order of the input
  std::size_t reference = 0;          // the default method, or else the first
  std::string route_label;            // meaning of route_m
  std::vector<double> route_m;        // position of each frame on the route; NaN if unknown
  double route_from_m = 0;
  double route_to_m = 0;
  // The errors drawn to scale, in either direction; some may lie beyond.
  double error_limit_m = 0;
  double lateral_limit_m = 0;  // the same for lateral errors

  bool has_route() const { return std::isfinite(route_from_m); }
  bool knows_lateral() const;  // whether some method does
  // REQUIRES: there is a method.
  const MethodSeries& reference_method() const { return methods[reference]; }
  // The drawing order: the reference method last, on top.
  std::vector<const MethodSeries*> back_to_front() const;
};

ReportSeries report_series(const ReportInput& input);

// The methods for which `shown` is true, with the scales of all. If the reference method is not
// among them, the first one becomes the reference.
ReportSeries only(const ReportSeries& all, const std::function<bool(const MethodSeries&)>& shown);

}  // namespace milepost
