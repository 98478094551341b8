// The parts of the report of a map.
#pragma once

#include <string>

#include "mapper/report/map_report_data.h"
#include "schema/page/report_json.h"

namespace milepost {

// Facts and result (map_report_head.cc).
PageHead map_head(const MapReportData& data);

// The stretches of all segments (map_report_stretches.cc): columns with a value each, what the
// readout tells of one, where it lies on the plan, and the views that colour it.
void add_stretches(Json& page, const MapReportData& data);
Json plan_part(const MapReportData& data);
Json strips_part(const MapReportData& data);   // all segments, by what needs a look first
Json segment_part(const MapReportData& data);  // the plots of one, chosen by the reader

// Distributions (map_report_histograms.cc).
Json histograms_part(const MapReportData& data);

// Tables (map_report_tables.cc).
Json check_points_part(const MapReportData& data);
Json findings_part(const MapReportData& data);
Json drives_part(const MapReportData& data);

}  // namespace milepost
