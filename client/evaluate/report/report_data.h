// The report of an evaluation as data (report_json.h).
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "client/evaluate/roads_around.h"
#include "schema/drive/drive.h"
#include "schema/page/report_json.h"

namespace milepost {

struct ReportInput {
  std::string map_name;    // NAME (build BUILD), for the heading
  std::string map_source;  // URL of the server or path of the file
  const Drive* drive = nullptr;
  std::vector<RoadAround> roads;          // of the map, around the drive; may be empty
  std::vector<MethodEvaluation> methods;  // of the same drive, one or more
};

// The input of report_page(). Deterministic.
Json report_data(const ReportInput& input);

}  // namespace milepost
