// A table of comma separated values in the making, as CsvTable reads it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "schema/base/digits.h"

namespace milepost {

class CsvText {
 public:
  // REQUIRES: `header` is the names of the columns, with commas between them.
  explicit CsvText(std::string_view header) : text_(header) { text_ += '\n'; }

  // The next cell of a row. REQUIRES: no comma, quote or end of line in `text`.
  CsvText& cell(std::string_view text) {
    if (is_in_row_) text_ += ',';
    text_ += text;
    is_in_row_ = true;
    return *this;
  }
  CsvText& cell(long long value) { return cell(std::string_view(std::to_string(value))); }
  CsvText& exact(double value) { return cell(std::string_view(shortest(value))); }
  CsvText& rounded(double value, int decimals) {
    return cell(std::string_view(fixed(value, decimals)));
  }
  // What is not known is an empty cell.
  CsvText& rounded(const std::optional<double>& value, int decimals) {
    return value ? rounded(*value, decimals) : cell(std::string_view());
  }

  void end_row() {
    text_ += '\n';
    is_in_row_ = false;
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool is_in_row_ = false;
};

}  // namespace milepost
