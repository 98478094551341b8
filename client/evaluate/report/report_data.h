// The report of an evaluation as data (report_json.h).
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "client/evaluate/report/report_json.h"
#include "schema/drive/drive.h"

namespace milepost {

struct ReportInput {
  std::string map_name;    // NAME (build BUILD), for the heading
  std::string map_source;  // URL of the server or path of the file
  const Drive* drive = nullptr;
  std::vector<GeoPoint> segment_line;  // of the segment driven longest; may be empty
  std::string segment;
  double segment_length_m = 0;
  std::vector<MethodEvaluation> methods;  // of the same drive, one or more
};

// The input of report_page(). Deterministic.
Json report_data(const ReportInput& input);

}  // namespace milepost
