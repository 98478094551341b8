// The subcommands of milepost-client.
#pragma once

#include <string>
#include <vector>

namespace milepost {

int run_find(const std::string& program, std::vector<std::string> words);
int run_localize(const std::string& program, std::vector<std::string> words);
int run_evaluate(const std::string& program, std::vector<std::string> words);
int run_vanishing(const std::string& program, std::vector<std::string> words);

}  // namespace milepost
