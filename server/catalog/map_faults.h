// Builds whose files turned out to be damaged after they were opened.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "schema/base/result.h"

namespace milepost::server {

// Safe to use from several threads at once.
class MapFaults {
 public:
  // Of several of a build the first is kept.
  void add(const std::string& map, const std::string& build, const Error& error) {
    const std::lock_guard lock(mutex_);
    faults_.emplace(std::pair(map, build), error);
  }
  // Of the builds for which `is_wanted(map, build)` holds; the others are forgotten.
  template <class Wanted>
  void keep_only(const Wanted& is_wanted) {
    const std::lock_guard lock(mutex_);
    std::erase_if(faults_, [&](const auto& fault) {
      return !is_wanted(fault.first.first, fault.first.second);
    });
  }
  std::map<std::pair<std::string, std::string>, Error> all() const {  // by map and build
    const std::lock_guard lock(mutex_);
    return faults_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Error> faults_;  // guarded by mutex_
};

}  // namespace milepost::server
