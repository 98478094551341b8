#pragma once

#include <string>
#include <vector>

namespace milepost {

// milepost-mapper build
int run_build(const std::string& program, std::vector<std::string> words);

}  // namespace milepost
