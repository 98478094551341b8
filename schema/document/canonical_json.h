// One text for a JSON value: documents that a digest covers have the same bytes wherever they are
// written (FORMAT.md 7.1).
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace milepost {

// The value by RFC 8785: no spaces, the fewest digits that restore a number, members by name; names
// are ordered by their bytes. REQUIRES: finite numbers, text in UTF-8, a depth within JsonLimits.
std::string canonical_json(const nlohmann::json& value);

}  // namespace milepost
