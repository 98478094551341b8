#include "mapper/cli/finding_output.h"

#include <nlohmann/json.hpp>

#include "schema/command/command.h"

namespace milepost {

Error error_of(const Finding& finding) {
  return {ErrorCode::invalid_input, finding.place(), finding.what, finding.hint};
}

void warn_of(const std::string& program, const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) warn(program, error_of(finding));
}

nlohmann::ordered_json json_of(const std::vector<Finding>& findings) {
  auto all = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    all.push_back({{"kind", finding.kind},
                   {"where", finding.where},
                   {"line", finding.line},
                   {"count", finding.count},
                   {"what", finding.what},
                   {"hint", finding.hint}});
  }
  return all;
}

}  // namespace milepost
