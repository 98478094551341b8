// The path and the query of a request, checked and percent-decoded.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "schema/base/result.h"

namespace milepost::server {

class Query {
 public:
  // The pairs of "a=1&b=2". Errors: invalid_input (percent-encoding, control bytes).
  static Result<Query> parse(std::string_view text);

  // Errors: invalid_input for a parameter that is not among `names`, or is there twice.
  Status allow_only(const std::vector<std::string_view>& names) const;
  // The value of a parameter. Errors: invalid_input (missing).
  Result<std::string> text(std::string_view name) const;
  // The value as a number, which may be infinite but not NaN. Errors: invalid_input.
  Result<double> number(std::string_view name) const;

 private:
  std::vector<std::pair<std::string, std::string>> pairs_;
};

struct Target {
  std::vector<std::string> path;  // the segments of "/a/b": "a", "b"
  Query query;

  // Takes "/path?query", or the absolute form "http://host/path?query" that proxies send.
  // Errors: invalid_input (form, percent-encoding, control bytes, "." or ".." as a segment).
  static Result<Target> parse(std::string_view target);
};

// The number that is all of `text`. `where` names it in the error.
// Errors: invalid_input (no number, NaN, too large for a double).
Result<double> parse_number(std::string_view text, const std::string& where);

}  // namespace milepost::server
