// The report of a found drive: one HTML file that needs nothing else.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/evaluate/find_drive.h"
#include "client/evaluate/report/backdrop.h"
#include "client/evaluate/report/find_recorder.h"

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

// The whole document, UTF-8. The same input gives the same bytes. Of all that the project computes
// about a found drive, only this looks at its recorded positions.
// REQUIRES: no pointer is null; there is a frame.
std::string find_report_html(const FindReportInput& input);

}  // namespace milepost
