// The summary table of the report.
#pragma once

#include <string>
#include <vector>

#include "client/cli/evaluation.h"

namespace milepost {

// One row a method, as HTML. With several methods the best of each column is marked.
std::string summary_table(const std::vector<MethodEvaluation>& methods);

}  // namespace milepost
