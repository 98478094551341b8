// The document of a map's current state (PROTOCOL.md); those of a build are in schema/document.
#pragma once

#include <string>

#include "schema/store/map_store.h"

namespace milepost::server {

// The document of GET /v1/maps/{map}: what the build's map document holds, with the map's name, the
// build and the segments' ids.
std::string current_map_document(const std::string& name, const MapReader& reader);

}  // namespace milepost::server
