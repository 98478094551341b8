// What a person should know about a network that was made all the same.
#pragma once

#include <string>

namespace milepost {

// Reported in one line: "WHERE: WHAT; HINT".
struct NetworkFinding {
  std::string where;  // drive, and the place on it
  std::string what;   // what was found there, and what was done about it
  std::string hint;   // what can be done about it; may be empty

  friend bool operator==(const NetworkFinding&, const NetworkFinding&) = default;
};

}  // namespace milepost
