// Documents in memory, parsed.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "client/cache/cache_entries.h"

namespace milepost {

// Recently read documents of one kind by their cache keys. Safe to use from several threads at
// once.
template <class Document>
class DocumentMemory {
 public:
  using Shared = std::shared_ptr<const Document>;

  Shared find(const CacheKey& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = documents_.find(parts_of(key));
    return found == documents_.end() ? nullptr : found->second;
  }

  void keep(const CacheKey& key, Shared document) {
    const std::lock_guard lock(mutex_);
    // The cache on disk has them all, so clearing the memory costs little.
    if (documents_.size() >= kMaxDocuments) documents_.clear();
    documents_[parts_of(key)] = std::move(document);
  }

 private:
  static constexpr std::size_t kMaxDocuments = 64;

  static std::array<std::string, 3> parts_of(const CacheKey& key) {
    return {key.map, key.build, key.segment};
  }

  mutable std::mutex mutex_;
  std::map<std::array<std::string, 3>, Shared> documents_;
};

}  // namespace milepost
