// The summary tables of the report.
#pragma once

#include <vector>

#include "client/evaluate/evaluation.h"
#include "schema/page/report_json.h"

namespace milepost {

// {columns, rows: [{cells, best}]}, one row per method. With several methods the best of each
// column is marked.
Json summary_table(const std::vector<MethodEvaluation>& methods);

// The same for lateral offset and heading, of the methods that estimate them; null if none does.
Json pose_table(const std::vector<MethodEvaluation>& methods);

}  // namespace milepost
