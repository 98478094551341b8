#pragma once

#include <string>
#include <vector>

namespace milepost {

// milepost-mapper aerial
int run_aerial(const std::string& program, std::vector<std::string> words);

}  // namespace milepost
