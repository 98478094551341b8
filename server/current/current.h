// A value that is used now; another one takes its place when what it was read from changes.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace milepost::server {

// Safe to use from several threads at once. Whoever takes a value keeps it to the end of its work.
template <class Value>
class Current {
 public:
  // REQUIRES: not null, here and in replace().
  explicit Current(std::shared_ptr<const Value> value) : value_(std::move(value)) {}

  std::shared_ptr<const Value> now() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }
  void replace(std::shared_ptr<const Value> value) {
    const std::lock_guard lock(mutex_);
    value_.swap(value);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Value> value_;  // guarded by mutex_
};

}  // namespace milepost::server
