// The catalog that is served now; another one takes its place when maps come and go.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "server/catalog/catalog.h"

namespace milepost::server {

// Safe to use from several threads at once. Whoever takes a catalog keeps it, and the maps in it,
// to the end of its answer.
class CurrentCatalog {
 public:
  explicit CurrentCatalog(std::shared_ptr<const Catalog> catalog) : catalog_(std::move(catalog)) {}

  std::shared_ptr<const Catalog> now() const {
    const std::lock_guard lock(mutex_);
    return catalog_;
  }
  void replace(std::shared_ptr<const Catalog> catalog) {
    const std::lock_guard lock(mutex_);
    catalog_.swap(catalog);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Catalog> catalog_;  // guarded by mutex_; never null
};

}  // namespace milepost::server
