// A found drive to report on: a real finder looks on black frames between four walls, and what it
// is said to have found is made up.
#pragma once

#include "client/evaluate/report/find_report_data.h"

namespace milepost::testing {

// A finder in a yard of 146 by 222 m that has seen a black frame.
Finder idle_finder(std::size_t particles);

// Frames as of straight_drive(), tracked from frame `found_from` on; each fix lies 2 m north of the
// truth and looks 3 degrees too far clockwise, with sigmas of 0.9 m and 2 degrees.
struct FoundRun {
  FoundRun(std::size_t frames, std::size_t found_from);

  // The run must outlive it.
  FindReportInput input() const;

  Drive drive;
  std::vector<FoundFrame> found;
  FindRecorder recorder;
};

}  // namespace milepost::testing
