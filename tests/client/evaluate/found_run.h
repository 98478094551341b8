// A global localization run for reports: a real localizer processes black frames between four
// walls, and its estimates are invented.
#pragma once

#include "client/evaluate/report/find_report_data.h"

namespace milepost::testing {

// A global localizer in a yard of 146 by 222 m that has processed a black frame.
GlobalLocalizer idle_finder(std::size_t particles);

// Frames of straight_drive(), tracked from frame `found_from` on; each fix lies 2 m north of the
// truth with a heading 3 degrees too far clockwise, and sigmas of 0.9 m and 2 degrees.
struct FoundRun {
  FoundRun(std::size_t frames, std::size_t found_from);

  // REQUIRES: the run outlives the result.
  FindReportInput input() const;

  Drive drive;
  std::vector<FoundFrame> found;
  FindRecorder recorder;
};

}  // namespace milepost::testing
