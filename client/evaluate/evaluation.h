// The errors of fixes relative to the recorded positions of a query drive.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "client/localize/localizer.h"
#include "schema/drive/drive.h"

namespace milepost {

// The fix of one frame of a drive, with its latency and estimates.
struct FrameFix {
  std::string filename;
  Fix fix;
  double latency_ms = 0;                         // from the decoded image to the fix
  std::vector<TrackletEstimate> estimates = {};  // that contributed to it, if requested
};

struct EvaluatedFix {
  FrameFix frame;
  // The segment that the recorded position, heading and altitude belong to (RoadTruth); empty off
  // the map.
  std::string truth_segment = {};
  std::optional<double> truth_along_m = {};  // on that segment
  // Fix - truth, if the fix has an arc length: along the segment; where they are on different
  // segments along the recorded direction, or, on a wrong road, the distance in plan.
  std::optional<double> error_m = {};
  // In plan, from the recorded position to the fix's; of a method that does not know its lateral
  // offset, to the line.
  std::optional<double> distance_m = {};
  bool is_on_wrong_segment = false;  // the fix is on another segment than the truth
  // Lateral offset of the recorded position from the segment's line, positive to the right.
  std::optional<double> truth_lateral_m = {};
  // Fix - truth, if the method estimates them.
  std::optional<double> lateral_error_m = {};
  std::optional<double> heading_error_deg = {};  // (-180, 180], positive clockwise
};

// Statistics of the absolute values of one kind of error; NaN if none is known.
struct ErrorFigures {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
};

// Errors are absolute values of EvaluatedFix::error_m over the localized frames; NaN without any.
struct Summary {
  std::string method;
  double mean_error_m = 0;
  double std_error_m = 0;
  double max_error_m = 0;
  double p50_error_m = 0;
  double p95_error_m = 0;
  std::size_t frames = 0;
  std::size_t localized_frames = 0;  // with an arc length
  double within_2_sigma = 0;         // share of the localized frames, [0, 1]
  double map_kb_per_m = 0;  // of the method's layers on the segments driven, 1 kB = 1000 bytes
  double latency_ms_p50 = 0;
  double latency_ms_p99 = 0;
  // Over the frames in which the method estimates them; NaN if it never does.
  ErrorFigures lateral_error_m;
  double lateral_within_2_sigma = std::numeric_limits<double>::quiet_NaN();  // share, [0, 1]
  ErrorFigures heading_error_deg;
  ErrorFigures distance_m;  // in plan, of all fixes with a position
  std::size_t wrong_segment_frames = 0;
  double within_2_sigma_map = 0;  // as within_2_sigma, of the sigma against the map

  bool knows_lateral() const { return std::isfinite(lateral_error_m.mean); }
};

struct MethodEvaluation {
  Summary summary;
  std::vector<EvaluatedFix> fixes;  // one per frame, in order
};

// Adds the ground truth: the segment, arc length and lateral offset of the recorded position, and
// the recorded heading. `layer` is that of the method. Errors: those of the source.
Result<MethodEvaluation> evaluate_fixes(const std::string& method, const std::string& layer,
                                        const Drive& drive, const std::vector<FrameFix>& fixes,
                                        MapSource& source);

}  // namespace milepost
