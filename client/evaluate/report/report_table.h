// The summary tables of the report.
#pragma once

#include <vector>

#include "client/evaluate/evaluation.h"
#include "client/evaluate/report/report_json.h"

namespace milepost {

// {columns, rows: [{cells, best}]}, one row a method. With several methods the best of each column
// is marked.
Json summary_table(const std::vector<MethodEvaluation>& methods);

// The same of lateral offset and heading, of the methods that know them; null where none does.
Json pose_table(const std::vector<MethodEvaluation>& methods);

}  // namespace milepost
