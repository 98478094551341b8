// A cache of values by text, bounded in bytes: what was not used for longest leaves first.
#pragma once

#include <cstddef>
#include <list>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace milepost::server {

// `Value` is cheap to copy: a shared pointer. Not safe to use from several threads at once.
template <class Value>
class LruCache {
 public:
  explicit LruCache(std::size_t bytes) : limit_(bytes) {}

  // Null if it is absent.
  Value find(std::string_view key) {
    const auto found = index_.find(key);
    if (found == index_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->value;
  }

  // Replaces the value of an equal key. Does nothing if `bytes`, the size of the value, are more
  // than half of the limit: a single value does not displace most others.
  void add(std::string_view key, Value value, std::size_t bytes) {
    const std::size_t size = bytes + key.size() + kOverhead;
    if (size > limit_ / 2) return;
    const auto same = index_.find(key);
    if (same != index_.end()) remove(same->second);
    while (bytes_ + size > limit_) remove(std::prev(entries_.end()));
    entries_.push_front({std::string(key), std::move(value), size});
    index_.emplace(entries_.front().key, entries_.begin());
    bytes_ += size;
  }

  void clear() {
    index_.clear();
    entries_.clear();
    bytes_ = 0;
  }

  std::size_t bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kOverhead = 256;  // of an entry, its nodes and its control block

  struct Entry {
    std::string key;
    Value value;
    std::size_t bytes = 0;
  };
  using Place = typename std::list<Entry>::iterator;

  void remove(Place place) {
    bytes_ -= place->bytes;
    index_.erase(place->key);
    entries_.erase(place);
  }

  const std::size_t limit_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;                           // last used first
  std::unordered_map<std::string_view, Place> index_;  // views of the entries' keys
};

}  // namespace milepost::server
