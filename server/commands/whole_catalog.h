// The maps of a directory for commands, which work on all of them or on none.
#pragma once

#include <memory>
#include <string>

#include "schema/base/result.h"
#include "server/catalog/catalog.h"

namespace milepost::server {

// As the server serves it. Errors: those of Catalog::open; invalid_input if a map would be left
// out; not_found if there is none.
Result<std::shared_ptr<const Catalog>> open_whole_catalog(const std::string& directory);

}  // namespace milepost::server
