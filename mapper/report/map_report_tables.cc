// The tables of the report of a map.
#include <cmath>

#include "mapper/report/map_report_parts.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

Json table_part(const std::string& heading, const std::string& note, Json columns, Json rows) {
  return {{"part", "table"},
          {"heading", heading},
          {"note", note},
          {"columns", std::move(columns)},
          {"rows", std::move(rows)}};
}

Json row_of(Json cells) { return {{"cells", std::move(cells)}}; }

std::string sentence(const std::string& what, const std::string& hint) {
  return hint.empty() ? what : what + "; " + hint;
}

Json fit_cells(const MappedDrive& drive) {
  if (!drive.fit)
    return Json::array({nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr});
  const PoseFit& fit = *drive.fit;
  const double share = fit.followed == 0 ? kNaN
                                         : 100 * static_cast<double>(fit.fitting) /
                                               static_cast<double>(fit.followed);
  return Json::array({fit.frames, fit.followed, rounded(share, 1), rounded(fit.reprojection_px, 2),
                      rounded(fit.plan_rms_m, 3), rounded(fit.up_rms_m, 3),
                      rounded(fit.heading_rms_deg, 2)});
}

}  // namespace

Json check_points_part(const MapReportData& data) {
  Json rows = Json::array();
  for (const CheckPointResidual& each : data.check_points) {
    Json cells = Json::array({each.mark, each.drive, each.sights});
    if (each.is_placed) {
      for (const double off_m :
           {std::hypot(each.east_m, each.north_m), each.east_m, each.north_m, each.up_m})
        cells.push_back(rounded(off_m, 3));
      cells.push_back(rounded(each.reprojection_px, 2));
    } else {
      for (int i = 0; i < 5; ++i) cells.push_back(nullptr);
    }
    rows.push_back(row_of(cells));
  }
  return table_part(
      "Surveyed marks",
      "From where a mark was surveyed to where the images of a drive have it on the map. Without "
      "numbers: its sights are too few, or look from one direction.",
      Json::array({words_column("mark"), text_column("drive"), table_column("sights", "", 0),
                   table_column("in plan", "m", 3), table_column("east", "m", 3),
                   table_column("north", "m", 3), table_column("up", "m", 3),
                   table_column("reprojection", "px", 2)}),
      rows);
}

Json findings_part(const MapReportData& data) {
  const std::string heading = "Findings of the build";
  if (!data.findings || data.findings->empty()) {
    return {
        {"part", "note"},
        {"heading", heading},
        {"text", data.findings
                     ? "The build found nothing that is probably wrong with the drives."
                     : "The map does not record what its build found: an older build made it."}};
  }
  Json rows = Json::array();
  for (const RecordedFinding& each : *data.findings) {
    std::string where = each.where;
    if (each.row > 0) where += ", row " + std::to_string(each.row);
    rows.push_back(row_of(
        Json::array({each.kind, each.drive, where, sentence(each.what, each.hint), each.count})));
  }
  return table_part(heading, "What is probably wrong with the drives of the map.",
                    Json::array({words_column("kind"), text_column("drive"), text_column("where"),
                                 text_column("what"), table_column("times", "", 0)}),
                    rows);
}

Json drives_part(const MapReportData& data) {
  const bool is_recorded = data.findings.has_value();
  Json columns = Json::array(
      {words_column("drive"), table_column("passes", "", 0), table_column("on the map", "m", 0)});
  if (is_recorded) {
    for (const Json& column :
         {table_column("frames", "", 0), table_column("features followed", "", 0),
          table_column("fitting", "%", 1), table_column("reprojection", "px", 2),
          table_column("plan", "m", 3), table_column("up", "m", 3),
          table_column("heading", "\u00B0", 2)})
      columns.push_back(column);
  }
  Json rows = Json::array();
  for (const MappedDrive& drive : data.drives) {
    Json cells = Json::array({drive.name, drive.passes, rounded(drive.length_m, 0)});
    if (is_recorded) {
      for (const Json& cell : fit_cells(drive)) cells.push_back(cell);
    }
    rows.push_back(row_of(cells));
  }
  return table_part(
      "The drives",
      is_recorded
          ? "What the images say of the recorded poses: the share of the followed features that "
            "fit the adjusted poses, their reprojection error, and how far the adjusted poses are "
            "from the recorded ones (root mean squares)."
          : "What the images say of the recorded poses is not recorded in this map.",
      columns, rows);
}

}  // namespace milepost
