// Maps published as plain files (PROTOCOL.md 6): a store that answers no query.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "client/fetch/documents.h"

namespace milepost {

// What the source has learned about the other side. Safe to use from several threads at once.
class StaticStore {
 public:
  using Segments = std::shared_ptr<const std::vector<PlacedSegment>>;

  // Whether the maps come from such a store, by the last list that came.
  bool is_known() const { return is_known_; }
  void note(bool is_static) { is_known_ = is_static; }

  // The URL of a document whose URL is also the start of others.
  std::string document_url(const std::string& url) const {
    return is_known_ ? index_url(url) : url;
  }
  static std::string index_url(const std::string& url) { return url + "/index.json"; }

  // All segments of the store's maps, listed less than a minute ago; null if they have to be
  // requested.
  Segments segments_at(std::int64_t now_s) const {
    const std::lock_guard lock(mutex_);
    return is_known_ && now_s < listed_until_s_ ? segments_ : nullptr;
  }
  void list(Segments segments, std::int64_t now_s) {
    const std::lock_guard lock(mutex_);
    segments_ = std::move(segments);
    listed_until_s_ = now_s + kListed_s;
  }

 private:
  static constexpr std::int64_t kListed_s = 60;

  std::atomic<bool> is_known_ = false;
  mutable std::mutex mutex_;  // guards all below
  Segments segments_;
  std::int64_t listed_until_s_ = 0;
};

}  // namespace milepost
