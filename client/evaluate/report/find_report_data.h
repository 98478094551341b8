// The report of a global localization run as data (report_json.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/evaluate/find_drive.h"
#include "client/evaluate/report/backdrop.h"
#include "client/evaluate/report/find_recorder.h"
#include "schema/page/report_json.h"

namespace milepost {

struct FindReportInput {
  std::string map_name;    // NAME (build BUILD), for the heading
  std::string map_source;  // URL of the server or path of the file
  std::string settings;    // of the filter, for the heading
  const Drive* drive = nullptr;
  const std::vector<FoundFrame>* frames = nullptr;  // those of the drive, in its order
  const FindRecorder* recorder = nullptr;           // that observed the run
  std::optional<Backdrop> backdrop;                 // none: the plans have a plain background
};

// The input of report_page(). Deterministic. Nothing else in the project uses the recorded
// positions of a global localization run. REQUIRES: no pointer is null; there is at least one
// frame.
Json find_report_data(const FindReportInput& input);

}  // namespace milepost
