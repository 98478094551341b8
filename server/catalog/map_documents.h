// The document of a map's current state (PROTOCOL.md); those of a build are in schema/document.
#pragma once

#include <string>
#include <vector>

namespace milepost::server {

// The document of GET /v1/maps/{map}: what the build's map document holds, with the map's name, the
// build and the segments' ids.
std::string current_map_document(const std::string& name, const std::string& build,
                                 const std::string& map_document,
                                 const std::vector<std::string>& segments);

}  // namespace milepost::server
