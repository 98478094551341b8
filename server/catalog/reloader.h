// Keeps the current catalog that of its directory.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "server/catalog/current_catalog.h"
#include "server/catalog/directory_watch.h"

namespace milepost::server {

struct ReloadSettings {
  std::chrono::milliseconds quiet{200};       // since the last change, before a look
  std::chrono::milliseconds patience{2'000};  // at most, while changes go on
  // A look without any change, for directories that are shared with other hosts.
  std::chrono::milliseconds interval{30'000};
};

// Looks at the files to which something happens, and at the whole directory when it is asked to and
// from time to time, on a thread of its own; ends the time of old builds. What changed is told to
// the log. A directory that cannot be read changes nothing.
class Reloader {
 public:
  // `also` is called at each look, on the same thread: for files that are followed likewise.
  Reloader(
      std::filesystem::path directory, std::shared_ptr<CurrentCatalog> catalog,
      const ReloadSettings& settings = {}, std::function<void()> also = [] {});
  ~Reloader();  // waits for the look that is under way
  Reloader(const Reloader&) = delete;
  Reloader& operator=(const Reloader&) = delete;

  // Looks soon. Safe to call from any thread.
  void look();
  // Looks that found a change, and looks that failed.
  std::uint64_t reloads() const { return reloads_; }
  std::uint64_t failures() const { return failures_; }

 private:
  void run();
  std::chrono::milliseconds wait_at_most() const;
  bool wait(std::chrono::milliseconds at_most);
  void settle();
  void reload();

  const std::filesystem::path directory_;
  const std::shared_ptr<CurrentCatalog> catalog_;
  const ReloadSettings settings_;
  const std::function<void()> also_;
  std::optional<DirectoryWatch> watch_;
  DirectoryChanges changes_;  // since the last look
  Catalog::Clock::time_point look_at_all_;
  bool has_failed_ = false;
  int wake_;  // an eventfd
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> reloads_{0};
  std::atomic<std::uint64_t> failures_{0};
  std::thread thread_;
};

}  // namespace milepost::server
