// Fetches the tiles ahead of the vehicle into the cache while it drives.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "client/fetch/map_source.h"

namespace milepost {

// One background thread over a source. The newest request replaces one that has not begun.
// Failures are kept for last_error() and do not disturb the localizer, which asks again itself.
// All members may be called from any thread.
class Prefetcher {
 public:
  explicit Prefetcher(std::shared_ptr<MapSource> source);
  ~Prefetcher();  // stops after the request that is under way
  Prefetcher(const Prefetcher&) = delete;
  Prefetcher& operator=(const Prefetcher&) = delete;

  void request(const MapVersion& version, const std::string& segment, const std::string& layer,
               const AlongRange& range);
  // Blocks until nothing is requested or under way.
  void wait_idle();
  std::optional<Error> last_error() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
