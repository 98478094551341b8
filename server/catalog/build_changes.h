// What differs between two builds of a map, tile by tile (PROTOCOL.md, changes).
#pragma once

#include <string>

#include "server/catalog/served_map.h"

namespace milepost::server {

// The JSON document. REQUIRES: both are builds of one map.
std::string changes_document(const ServedMap& from, const ServedMap& to);

}  // namespace milepost::server
