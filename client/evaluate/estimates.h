// What single tracklets said, and what they were made of: for those who study the estimates.
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

// Whether some frame was followed by tracklets.
bool has_estimates(const std::vector<EvaluatedFix>& fixes);

// estimates-METHOD.csv: one row a matched tracklet of each frame that has a fix.
std::string estimates_csv(const std::vector<EvaluatedFix>& fixes);

// regressions.csv: the observations of the tracklets around a fix that were followed the longest,
// one row an observation, of the layer `observations`. Nothing where the map has no such layer.
// Errors: those of the source; corrupt (a tile).
Result<std::optional<std::string>> regressions_csv(MapSource& source, const Fix& fix);

}  // namespace milepost
