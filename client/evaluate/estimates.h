// The estimates of single tracklets and their observations, for studies of the estimates.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "schema/base/output_file.h"

namespace milepost {

// estimates-METHOD.csv and regressions.csv of evaluate.
extern const OutputKind kEstimatesOutput;
extern const OutputKind kRegressionsOutput;

// Whether some frame was tracked by tracklets.
bool has_estimates(const std::vector<EvaluatedFix>& fixes);

// estimates-METHOD.csv: one row per matched tracklet of each frame with a fix.
std::string estimates_csv(const std::vector<EvaluatedFix>& fixes);

// regressions.csv: the observations of the longest tracklets around a fix, one row per observation,
// from the layer `observations`. None if the map has no such layer. Errors: those of the source;
// corrupt (a tile).
Result<std::optional<std::string>> regressions_csv(MapSource& source, const Fix& fix);

}  // namespace milepost
