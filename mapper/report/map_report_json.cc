#include "mapper/report/map_report_json.h"

#include <utility>

#include "mapper/report/map_report_parts.h"

namespace milepost {

Json map_report_json(const MapReportData& data) {
  Json page = json_of(map_head(data));
  page["columns"] = Json::object();
  Json parts = Json::array();
  if (!data.segments.empty()) {
    add_stretches(page, data);
    parts.push_back(plan_part(data));
    parts.push_back(strips_part(data));
    parts.push_back(segment_part(data));
    parts.push_back(histograms_part(data));
  }
  if (!data.check_points.empty()) parts.push_back(check_points_part(data));
  parts.push_back(findings_part(data));
  parts.push_back(drives_part(data));
  page["parts"] = std::move(parts);
  return page;
}

}  // namespace milepost
