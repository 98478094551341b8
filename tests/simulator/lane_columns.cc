#include "tests/simulator/lane_columns.h"

#include <sstream>

#include "schema/base/file.h"

namespace milepost::simulator {

Status add_columns(const std::filesystem::path& table, const std::string& header,
                   const std::vector<std::string>& cells) {
  const Result<std::string> text = read_text_file(table);
  if (!text) return text.error();
  std::istringstream lines(*text);
  std::string line;
  std::string wider;
  std::size_t row = 0;
  while (std::getline(lines, line)) {
    wider += line + "," + (row == 0 ? header : cells[row - 1]) + "\n";
    ++row;
  }
  return write_text_file(table, wider);
}

}  // namespace milepost::simulator
