// The signatures of the builds that are served, also of those that were replaced: beside the map's
// file lies the new build's signature then.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "schema/base/result.h"

namespace milepost::server {

// A build, and where its signature may be.
struct SignedPlace {
  std::string map;
  std::string build;
  std::filesystem::path file;       // of the map, where the build is or was
  std::filesystem::path kept_file;  // of kept_builds.h, which need not exist
  bool is_current = false;
};

// Safe to use from several threads at once.
class Signatures {
 public:
  // The text of a build's signature: that beside its file, read at every call; if that is of
  // another build, the one of the kept file, or the last that was seen. Errors: not_found (there is
  // none; that of a current build was removed, or names another map), corrupt, io.
  Result<std::string> of(const SignedPlace& place);

  // Sees the signature beside the file of a build, before another takes its place.
  void see(const std::string& map, const std::string& build, const std::filesystem::path& file);

  // Of the builds for which `is_wanted(map, build)` holds; the others are forgotten.
  template <class Wanted>
  void keep_only(const Wanted& is_wanted) {
    const std::lock_guard lock(mutex_);
    std::erase_if(seen_, [&](const auto& signature) {
      return !is_wanted(signature.first.first, signature.first.second);
    });
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::string> seen_;  // guarded by mutex_
};

}  // namespace milepost::server
