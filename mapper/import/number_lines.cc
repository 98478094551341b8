#include "mapper/import/number_lines.h"

#include <sstream>

#include "schema/base/file.h"
#include "schema/base/number.h"

namespace milepost {
namespace {

Result<std::vector<double>> numbers_in(const std::string& text, const std::string& place,
                                       std::size_t least) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto value = finite_number(word);
    if (!value) {
      return Error{ErrorCode::invalid_input, place,
                   "'" + word.substr(0, 40) + "' is not a finite number", "correct the line"};
    }
    numbers.push_back(*value);
  }
  if (numbers.size() >= least) return numbers;
  return Error{
      ErrorCode::invalid_input, place,
      "there are " + std::to_string(numbers.size()) + " numbers, not " + std::to_string(least),
      "check that the file is of this layout"};
}

}  // namespace

Result<std::vector<NumberLine>> number_lines(const std::filesystem::path& file, std::size_t least) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  std::vector<NumberLine> lines;
  std::istringstream stream(*text);
  std::string line;
  for (std::size_t at = 1; std::getline(stream, line); ++at) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    auto numbers = numbers_in(line, file.string() + ", line " + std::to_string(at), least);
    if (!numbers) return numbers.error();
    lines.push_back({at, std::move(*numbers)});
  }
  if (!lines.empty()) return lines;
  return Error{ErrorCode::invalid_input, file.string(), "holds no line of numbers",
               "check that the file is of this layout"};
}

Result<std::vector<double>> numbers_of_key(const std::filesystem::path& file,
                                           const std::string& key, std::size_t least) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  std::istringstream stream(*text);
  std::string line;
  for (std::size_t at = 1; std::getline(stream, line); ++at) {
    if (!line.starts_with(key + ":")) continue;
    return numbers_in(line.substr(key.size() + 1), file.string() + ", line " + std::to_string(at),
                      least);
  }
  return Error{ErrorCode::invalid_input, file.string(), "has no line '" + key + ": ...'",
               "check that the file is of this layout"};
}

}  // namespace milepost
