#include "mapper/import/what_names.h"

#include <algorithm>

namespace milepost {

Result<std::map<std::string, std::string>> names_by_what(const std::string& option,
                                                         const std::vector<std::string>& words,
                                                         const std::vector<std::string>& whats) {
  std::map<std::string, std::string> names;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string what = word.substr(0, equals);
    if (equals == std::string::npos || std::ranges::find(whats, what) == whats.end()) {
      std::string all;
      for (const std::string& each : whats) all += (all.empty() ? "" : ", ") + each;
      return Error{ErrorCode::invalid_input, option, "'" + word + "' is not WHAT=NAME",
                   "WHAT is one of " + all};
    }
    names[what] = word.substr(equals + 1);
  }
  return names;
}

}  // namespace milepost
