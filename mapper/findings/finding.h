// What a person should know of drives that can be read all the same.
#pragma once

#include <cstddef>
#include <string>

namespace milepost {

// Reported in one line: "WHERE, line LINE: WHAT; HINT".
struct Finding {
  std::string kind;       // lower case, words joined by '_'; FINDINGS.md lists them
  std::string where;      // a file, or a drive and the place on it
  std::size_t line = 0;   // of the file, the first that shows it; 0: of no line
  std::size_t count = 0;  // of rows or frames that show it
  std::string what;       // what was found there, and what was done about it
  std::string hint;       // what can be done about it; may be empty

  std::string place() const { return line == 0 ? where : where + ", line " + std::to_string(line); }
  friend bool operator==(const Finding&, const Finding&) = default;
};

}  // namespace milepost
