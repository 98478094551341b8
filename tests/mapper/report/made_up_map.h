// A map of straight segments with landmarks where a test wants them.
#pragma once

#include <string>
#include <vector>

#include "mapper/report/map_report_data.h"
#include "schema/base/range.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {

// A segment due north.
struct MadeUpSegment {
  std::string id = "monday-0";
  double length_m = 57;
  double east_m = 0;                           // of the others
  std::vector<AlongRange> mapped = {{0, 57}};  // where landmarks begin, 4 a metre ...
  double seen_over_m = 12;                     // ... and how far each is seen
  std::uint8_t landmark_passes = 1;            // that saw each landmark
  std::vector<StoredPass> passes = {{"monday", 0, 57}};
  PositionError position_error = {0.18, 200.0, true};
};

// The report's data of a map of these segments. Fails the test if there is an error.
MapReportData made_up_report(const std::vector<MadeUpSegment>& segments,
                             const std::optional<MappingRecord>& record = std::nullopt);

}  // namespace milepost::testing
