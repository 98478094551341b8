// The files that the commands write: fixes and summaries.
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "schema/base/output_file.h"

namespace milepost {

// Files with a row a frame that begins with timestamp_s, filename, status: fixes of any command.
extern const OutputKind kFixesOutput;
// summary.json of evaluate.
extern const OutputKind kSummaryOutput;

// fixes.csv of localize: one row a frame. Cells that are not known are empty.
std::string fixes_csv(const std::vector<FrameFix>& fixes);
// fixes-METHOD.csv of evaluate: the same with truth_along_m,error_m added after latency_ms, and the
// truth and errors of lateral and heading at the end.
std::string evaluated_fixes_csv(const std::vector<EvaluatedFix>& fixes);
// summary.json: a list, one object a method. Figures that are not known are null.
std::string summary_json(const std::vector<MethodEvaluation>& methods);
// The same for a person, as an aligned table; "-" for a lateral or heading that is not known.
std::string summary_text(const std::vector<MethodEvaluation>& methods);

}  // namespace milepost
