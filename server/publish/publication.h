// Writes a catalog as plain files: what the server would answer, under paths that mirror its URLs
// (PROTOCOL.md 6).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "schema/base/result.h"
#include "server/catalog/catalog.h"

namespace milepost::server {

struct PublishSettings {
  std::filesystem::path folder;
  bool remove_old = false;  // builds and maps that are no longer in the catalog
  std::function<void(const std::string& progress)> on_progress;
  std::function<bool()> stopped;
};

struct PublishCounts {
  std::size_t files = 0;
  std::size_t written = 0;  // of them, those that were not there
  std::size_t removed = 0;  // old builds
};

// Documents are written after what they point to, so that the tree is valid at any time. Errors:
// those of StaticTree; invalid_input (a name that the tree reserves); corrupt, io (a map);
// cancelled.
Result<PublishCounts> publish(const Catalog& catalog, const PublishSettings& settings);

}  // namespace milepost::server
