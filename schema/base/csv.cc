#include "schema/base/csv.h"

#include <algorithm>
#include <numeric>

#include "schema/base/file.h"
#include "schema/base/number.h"

namespace milepost {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Removes a cell from the front of `line`, with the separator after it, if there is one. A quoted
// cell may hold separators, and quotes written twice. Nothing if a quote is not closed.
std::optional<std::string> take_cell(std::string_view& line, char separator, bool& is_last) {
  const std::size_t first = line.find_first_not_of(' ');
  std::string cell;
  std::size_t end = 0;
  if (first != std::string_view::npos && line[first] == '"') {
    std::size_t at = first + 1;
    for (;; ++at) {
      if (at >= line.size()) return std::nullopt;
      if (line[at] != '"') {
        cell += line[at];
      } else if (at + 1 < line.size() && line[at + 1] == '"') {
        cell += line[at++];
      } else {
        break;
      }
    }
    end = line.find(separator, at);
  } else {
    end = line.find(separator);
    cell = trimmed(line.substr(0, end));
  }
  is_last = end == std::string_view::npos;
  line.remove_prefix(is_last ? line.size() : end + 1);
  return cell;
}

// Nothing if a quote is not closed.
std::optional<std::vector<std::string>> split(std::string_view line, char separator) {
  std::vector<std::string> cells;
  for (bool is_last = false; !is_last;) {
    std::optional<std::string> cell = take_cell(line, separator, is_last);
    if (!cell) return std::nullopt;
    cells.push_back(std::move(*cell));
  }
  return cells;
}

// As spreadsheets write tables: where the comma separates decimals, a semicolon or a tab separates
// cells.
char separator_of(std::string_view header) {
  for (const char separator : {',', ';', '\t'})
    if (header.find(separator) != std::string_view::npos) return separator;
  return ',';
}

Error unclosed_quote(const std::filesystem::path& path, std::size_t line) {
  return {ErrorCode::invalid_input, path.string() + ", line " + std::to_string(line),
          "a quote is not closed", "write each row on one line"};
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
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    return Error{ErrorCode::invalid_input, path.string(), "is a table in UTF-16",
                 "save it as CSV in UTF-8"};
  }

  CsvTable table;
  table.path_ = path;
  table.columns_ = columns;
  const std::string_view first_line = take_line(text);
  table.separator_ = separator_of(first_line);
  const auto split_header = split(first_line, table.separator_);
  if (!split_header) return unclosed_quote(path, 1);
  const std::vector<std::string>& header = *split_header;
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
    if (trimmed(row).empty()) continue;
    const auto split_row = split(row, table.separator_);
    if (!split_row) return unclosed_quote(path, line);
    const std::vector<std::string>& cells = *split_row;
    const std::size_t needed = cell_of.empty() ? 0 : std::ranges::max(cell_of) + 1;
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
  std::string digits = cell;
  if (digits.starts_with('+')) digits.erase(0, 1);
  if (separator_ != ',' && digits.find('.') == std::string::npos)
    std::ranges::replace(digits, ',', '.');  // a decimal comma
  const auto value = finite_number(digits);
  if (!value) {
    return Error{ErrorCode::invalid_input, place(row),
                 columns_[column] + " is '" + cell + "', not a finite number",
                 "correct or remove the row"};
  }
  return *value;
}

std::string CsvTable::place(std::size_t row) const {
  return path_.string() + ", line " + std::to_string(lines_[row]);
}

}  // namespace milepost
