// Text files of numbers, some a line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "schema/base/result.h"

namespace milepost {

struct NumberLine {
  std::size_t line = 0;
  std::vector<double> numbers;
};

// Lines that begin with '#' and empty ones are left out. Errors: not_found, io; invalid_input for
// a word that is no finite number, or fewer than `least` numbers in a line.
Result<std::vector<NumberLine>> number_lines(const std::filesystem::path& file, std::size_t least);

// The numbers after "KEY:" in a file of such lines, as KITTI's calibrations are. Errors: not_found,
// io; invalid_input, also if there are fewer than `least`.
Result<std::vector<double>> numbers_of_key(const std::filesystem::path& file,
                                           const std::string& key, std::size_t least);

}  // namespace milepost
