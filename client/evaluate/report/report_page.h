// A report's data as a page that needs nothing else.
#pragma once

#include <string>

#include "client/evaluate/report/report_json.h"
#include "schema/base/output_file.h"

namespace milepost {

// A page of any kind, also of an older version.
extern const OutputKind kReportOutput;

// The whole document, UTF-8: the template, style sheet, scripts and charting library of the
// program, and the data. Whatever texts the data holds, nothing of them is markup or runs: they
// stand in one JSON text without '<', and the page lets only its own scripts run and loads nothing.
// Bytes that are not UTF-8 become U+FFFD.
std::string report_page(const Json& data);

}  // namespace milepost
