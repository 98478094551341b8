// The catalog that is served now; another one takes its place when maps come and go.
#pragma once

#include "server/catalog/catalog.h"
#include "server/current/current.h"

namespace milepost::server {

// Whoever takes a catalog keeps it, and the maps in it, to the end of its answer.
using CurrentCatalog = Current<Catalog>;

}  // namespace milepost::server
