// How commands tell findings.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "mapper/findings/finding.h"
#include "schema/base/result.h"

namespace milepost {

// As a warning or an error of one line.
Error error_of(const Finding& finding);
void warn_of(const std::string& program, const std::vector<Finding>& findings);
// A list of objects with the fields of Finding.
nlohmann::ordered_json json_of(const std::vector<Finding>& findings);

}  // namespace milepost
