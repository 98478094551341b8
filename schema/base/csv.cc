#include "schema/base/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "schema/base/file.h"

namespace milepost {
namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string joined(const std::vector<std::string>& cells) {
  std::string text;
  for (const auto& cell : cells) text += (text.empty() ? "" : ",") + cell;
  return text;
}

// Removes the first line from `text` and returns it without its line end (LF or CRLF).
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace

Result<CsvTable> CsvTable::read(const std::filesystem::path& path,
                                const std::vector<std::string>& columns,
                                const std::vector<std::string>& further) {
  const Result<std::string> content = read_text_file(path);
  if (!content) return content.error();
  std::string_view text = *content;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark

  CsvTable table;
  table.path_ = path;
  table.columns_ = columns;
  const std::vector<std::string> header = split(take_line(text));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i >= header.size() || header[i] != columns[i]) {
      const std::string found = i < header.size() ? "'" + header[i] + "'" : "missing";
      return Error{
          ErrorCode::invalid_input, path.string() + ", line 1",
          "column " + std::to_string(i + 1) + " is " + found + ", expected '" + columns[i] + "'",
          "start the header with " + joined(columns)};
    }
  }
  std::vector<std::size_t> cell_of(columns.size());  // of each column that is read
  std::iota(cell_of.begin(), cell_of.end(), 0);
  for (std::size_t i = columns.size(); i < header.size(); ++i) {
    const bool is_read = std::ranges::find(further, header[i]) != further.end();
    if (!is_read || std::ranges::find(table.columns_, header[i]) != table.columns_.end()) continue;
    table.columns_.push_back(header[i]);
    cell_of.push_back(i);
  }
  for (std::size_t line = 2; !text.empty(); ++line) {
    const std::string_view row = take_line(text);
    if (row.empty()) continue;
    const std::vector<std::string> cells = split(row);
    const std::size_t needed = cell_of.back() + 1;
    if (cells.size() < needed) {
      return Error{
          ErrorCode::invalid_input, path.string() + ", line " + std::to_string(line),
          "the row has " + std::to_string(cells.size()) + " cells, not " + std::to_string(needed),
          "complete or remove the row"};
    }
    std::vector<std::string>& kept = table.rows_.emplace_back();
    for (const std::size_t cell : cell_of) kept.push_back(cells[cell]);
    table.lines_.push_back(line);
  }
  return table;
}

std::optional<std::size_t> CsvTable::column(const std::string& name) const {
  const auto found = std::ranges::find(columns_, name);
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

Result<double> CsvTable::number(std::size_t row, std::size_t column) const {
  const std::string& cell = rows_[row][column];
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
    return Error{ErrorCode::invalid_input, place(row),
                 columns_[column] + " is '" + cell + "', not a finite number",
                 "correct or remove the row"};
  }
  return value;
}

std::string CsvTable::place(std::size_t row) const {
  return path_.string() + ", line " + std::to_string(lines_[row]);
}

}  // namespace milepost
