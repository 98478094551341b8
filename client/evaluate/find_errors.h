// How well a found drive agrees with where the vehicle really was. The finder knows none of this.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "client/evaluate/find_drive.h"

namespace milepost {

// Whether the vehicle counts as found: tracking or predicted.
bool is_tracked(FindStatus status);

// Distances from the recorded pose of a frame; NaN where that is not valid.
struct FindError {
  double position_m = 0;   // along the ground
  double heading_deg = 0;  // (-180, 180], positive clockwise
};

// How far numbers of one kind are off, as absolute values; NaN without any.
struct FindErrorFigures {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double p50 = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
  double within_2_sigma = std::numeric_limits<double>::quiet_NaN();  // share, [0, 1]
};

// Farther off than that, a vehicle is taken to be in another street.
inline constexpr double kWrongPlaceM = 10;

struct FindSummary {
  std::size_t frames = 0;
  std::size_t tracked_frames = 0;
  std::optional<std::size_t> found_frame;  // the first that was tracked
  double found_after_s = 0;                // since the first frame; 0 where nothing was found
  FindErrorFigures position_m;             // of the tracked frames
  FindErrorFigures heading_deg;            // of the same
  std::size_t wrong_frames = 0;            // of the same: more than kWrongPlaceM off
  double latency_ms_p50 = std::numeric_limits<double>::quiet_NaN();  // of all frames
  double latency_ms_p99 = std::numeric_limits<double>::quiet_NaN();
};

// One a frame. REQUIRES: `frames` are those of the drive, in its order.
std::vector<FindError> find_errors(const Drive& drive, const std::vector<FoundFrame>& frames);

// REQUIRES: the errors are of the frames.
FindSummary find_summary(const std::vector<FoundFrame>& frames,
                         const std::vector<FindError>& errors);

}  // namespace milepost
