// The summary table of the report.
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"

namespace milepost {

// One row a method, as HTML. With several methods the best of each column is marked.
std::string summary_table(const std::vector<MethodEvaluation>& methods);

// The same of lateral and heading, of the methods that know them; empty where none does.
std::string pose_table(const std::vector<MethodEvaluation>& methods);

}  // namespace milepost
