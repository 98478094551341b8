// The output files of the commands: fixes and summaries.
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "schema/base/output_file.h"

namespace milepost {

// Files with one row per frame that begins with timestamp_s, filename, status: fixes of any
// command.
extern const OutputKind kFixesOutput;
// summary.json of evaluate.
extern const OutputKind kSummaryOutput;

// fixes.csv of localize: one row per frame. Unknown cells are empty.
std::string fixes_csv(const std::vector<FrameFix>& fixes);
// fixes-METHOD.csv of evaluate: the same with truth_along_m and error_m after latency_ms, and the
// ground truth and errors of lateral offset, heading and position at the end.
std::string evaluated_fixes_csv(const std::vector<EvaluatedFix>& fixes);
// summary.json: a list with one object per method. Unknown figures are null.
std::string summary_json(const std::vector<MethodEvaluation>& methods);
// The same as an aligned table for people; "-" for an unknown lateral offset or heading.
std::string summary_text(const std::vector<MethodEvaluation>& methods);

}  // namespace milepost
