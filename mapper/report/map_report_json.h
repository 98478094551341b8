// The report of a map as data of a page (schema/page/report_json.h).
#pragma once

#include "mapper/report/map_report_data.h"
#include "schema/page/report_json.h"

namespace milepost {

// The input of report_page(). Deterministic.
Json map_report_json(const MapReportData& data);

}  // namespace milepost
