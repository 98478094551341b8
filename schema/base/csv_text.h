// Writes CSV text that CsvTable reads.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "schema/base/digits.h"

namespace milepost {

class CsvText {
 public:
  // REQUIRES: `header` holds the column names, separated by commas.
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
  // An empty cell if there is no value.
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
