// The report of a found drive, as data (report_json.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/evaluate/find_drive.h"
#include "client/evaluate/report/backdrop.h"
#include "client/evaluate/report/find_recorder.h"
#include "client/evaluate/report/report_json.h"

namespace milepost {

struct FindReportInput {
  std::string map_name;    // NAME (build BUILD), for the heading
  std::string map_source;  // URL of the server or path of the file
  std::string settings;    // of the filter, for the heading
  const Drive* drive = nullptr;
  const std::vector<FoundFrame>* frames = nullptr;  // those of the drive, in its order
  const FindRecorder* recorder = nullptr;           // that looked on
  std::optional<Backdrop> backdrop;                 // none: the plans have a plain ground
};

// What report_page() makes a page of. The same input gives the same data. Of all that the project
// computes about a found drive, only this looks at its recorded positions.
// REQUIRES: no pointer is null; there is a frame.
Json find_report_data(const FindReportInput& input);

}  // namespace milepost
