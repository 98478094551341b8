// The errors of global localization relative to the recorded poses of a drive, which the localizer
// does not use.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "client/evaluate/find_drive.h"

namespace milepost {

// Whether the vehicle counts as found: tracking or predicted.
bool is_tracked(GlobalStatus status);

// Errors relative to the recorded pose of a frame; NaN if that is not valid.
struct FindError {
  double position_m = 0;   // horizontal distance
  double heading_deg = 0;  // (-180, 180], positive clockwise
};

// Statistics of the absolute values of one kind of error; NaN without any.
struct FindErrorFigures {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double p50 = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
  double within_2_sigma = std::numeric_limits<double>::quiet_NaN();  // share, [0, 1]
};

// An error above this counts as a wrong position: another street.
inline constexpr double kWrongPlaceM = 10;

struct FindSummary {
  std::size_t frames = 0;
  std::size_t tracked_frames = 0;
  std::optional<std::size_t> found_frame;  // the first that was tracked
  double found_after_s = 0;                // since the first frame; 0 if never found
  FindErrorFigures position_m;             // of the tracked frames
  FindErrorFigures heading_deg;            // of the same
  std::size_t wrong_frames = 0;            // of the same: error above kWrongPlaceM
  double latency_ms_p50 = std::numeric_limits<double>::quiet_NaN();  // of all frames
  double latency_ms_p99 = std::numeric_limits<double>::quiet_NaN();
};

// One per frame. REQUIRES: `frames` are those of the drive, in its order.
std::vector<FindError> find_errors(const Drive& drive, const std::vector<FoundFrame>& frames);

// REQUIRES: `errors` are those of `frames`.
FindSummary find_summary(const std::vector<FoundFrame>& frames,
                         const std::vector<FindError>& errors);

}  // namespace milepost
