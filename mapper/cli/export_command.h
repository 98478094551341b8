#pragma once

#include <string>
#include <vector>

namespace milepost {

// milepost-mapper export
int run_export(const std::string& program, std::vector<std::string> words);

}  // namespace milepost
