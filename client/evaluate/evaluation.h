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
  std::optional<double> truth_along_m;  // on the fix's segment, or the nearest one without a fix
  std::optional<double> error_m;        // fix - truth, if the fix has an arc length
  // Lateral offset of the recorded position from the same segment's line, positive to the right.
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

  bool knows_lateral() const { return std::isfinite(lateral_error_m.mean); }
};

struct MethodEvaluation {
  Summary summary;
  std::vector<EvaluatedFix> fixes;  // one per frame, in order
};

// Adds the ground truth: arc length and lateral offset of the recorded position relative to the
// segment's line, and the recorded heading. `layer` is that of the method. Errors: those of the
// source.
Result<MethodEvaluation> evaluate_fixes(const std::string& method, const std::string& layer,
                                        const Drive& drive, const std::vector<FrameFix>& fixes,
                                        MapSource& source);

}  // namespace milepost
