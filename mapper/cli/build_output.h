// How the command build tells what it did.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "mapper/pipeline/build_map.h"

namespace milepost {

// A line for each map, and one for the check points.
std::string text_of(const BuildReport& report);
nlohmann::ordered_json json_of(const BuildReport& report);

}  // namespace milepost
