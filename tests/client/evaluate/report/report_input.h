// Evaluations for reports: an analytic drive, so that a test knows the expected drawing.
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/report/report_data.h"

namespace milepost::testing {

// Frames 1 m and 0.1 s apart on a line that climbs 3 m north on every 4 m east.
Drive straight_drive(std::size_t frames);

// A method whose fix of frame i is off by errors_m[i]; NaN makes a lost frame without a fix.
// The summary's numbers are plausible, not computed.
MethodEvaluation evaluation(const std::string& method, const Drive& drive,
                            const std::vector<double>& errors_m);

// Adds to each fix a lateral offset with 0.4 times its arc length error, and a heading with an
// error of as many degrees. The summary's numbers are plausible, not computed.
void know_lateral(MethodEvaluation& method);

// Small errors of both signs, the same for each call.
std::vector<double> small_errors(std::size_t frames, double scale_m);

// REQUIRES: the drive outlives the input.
ReportInput report_input(const Drive& drive, std::vector<MethodEvaluation> methods);

}  // namespace milepost::testing
