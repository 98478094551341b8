// A report as a self-contained HTML page.
#pragma once

#include <string>

#include "schema/base/output_file.h"
#include "schema/page/report_json.h"

namespace milepost {

// A report page of any kind or version.
extern const OutputKind kReportOutput;

// The whole document in UTF-8: template, style sheet, scripts, charting library and data. Strings
// in the data cannot become markup or code: the data is one JSON text without '<', and the page's
// content security policy allows only its own scripts and no loading. Bytes that are not UTF-8
// become U+FFFD.
std::string report_page(const Json& data);

}  // namespace milepost
