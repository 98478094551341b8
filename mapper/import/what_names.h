// Names that an option gives as WHAT=NAME.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "schema/base/result.h"

namespace milepost {

// The names by what they name. Errors: invalid_input (a word that is not WHAT=NAME, or names
// something else than one of `whats`), which names the option.
Result<std::map<std::string, std::string>> names_by_what(const std::string& option,
                                                         const std::vector<std::string>& words,
                                                         const std::vector<std::string>& whats);

}  // namespace milepost
