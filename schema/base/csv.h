// CSV tables, the format of drives and fixes, also as spreadsheets write them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/result.h"

namespace milepost {

// A table in memory. Lines are numbered as in an editor: the header is line 1. Cells are separated
// by commas; or, if the header has none, by semicolons or tabs, and then numbers may have a decimal
// comma. Cells may be quoted, on one line; blanks around a cell that is not are left out.
class CsvTable {
 public:
  // Reads a file whose header starts with `columns`, in that order. Of the columns that follow,
  // those that `further` names are read, wherever they are; all others are ignored.
  // Errors: not_found, io; invalid_input for another header or a row with too few cells.
  static Result<CsvTable> read(const std::filesystem::path& path,
                               const std::vector<std::string>& columns,
                               const std::vector<std::string>& further = {});

  std::size_t row_count() const { return rows_.size(); }
  // The number of a further column; nothing if the table does not have it.
  std::optional<std::size_t> column(const std::string& name) const;
  const std::string& text(std::size_t row, std::size_t column) const { return rows_[row][column]; }
  // A finite number. Errors: invalid_input that names file, line and column.
  Result<double> number(std::size_t row, std::size_t column) const;

  std::size_t line(std::size_t row) const { return lines_[row]; }
  // "FILE, line N", for messages about a row.
  std::string place(std::size_t row) const;

 private:
  std::filesystem::path path_;
  char separator_ = ',';
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> lines_;
};

}  // namespace milepost
