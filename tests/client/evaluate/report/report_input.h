// Evaluations to report on: an analytic drive, so that a test knows what must be drawn.
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

// Gives each fix a lateral, off by 0.4 times its error along, and a heading off by as many degrees.
// The summary's numbers are plausible, not computed.
void know_lateral(MethodEvaluation& method);

// Small errors on both sides of zero, the same for each call.
std::vector<double> small_errors(std::size_t frames, double scale_m);

// The drive must outlive the input.
ReportInput report_input(const Drive& drive, std::vector<MethodEvaluation> methods);

}  // namespace milepost::testing
