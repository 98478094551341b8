// Loads the map data that a vehicle wants into memory, concurrently with the frames: no frame
// waits.
#pragma once

#include <memory>
#include <string>

#include "client/fetch/held_map.h"
#include "client/fetch/map_source.h"
#include "client/fetch/provider_state.h"
#include "client/fetch/wants.h"

namespace milepost {

// Has two threads: one reads the cache or the map file, one requests from the network, so that
// stored tiles never wait for a server. Failed requests are repeated with a backoff. All members
// may be called from any thread; only wait_for_change() waits for the threads.
class TileProvider {
 public:
  // For one layer of the source's maps.
  TileProvider(const std::shared_ptr<MapSource>& source, std::string layer,
               const ProviderSettings& settings = {});
  // Returns within a second, even if the source hangs.
  ~TileProvider();
  TileProvider(const TileProvider&) = delete;
  TileProvider& operator=(const TileProvider&) = delete;

  // Replaces what is wanted.
  void want(Wants wants);
  Wants wanted() const;
  // The data that has arrived so far.
  std::shared_ptr<const HeldMap> held() const;

  // Whether everything wanted is held, or its request has failed.
  bool is_settled() const;
  // For replays of recorded drives: blocks until settled, until something has arrived since
  // `before` (for which more may be wanted), or until `deadline`.
  void wait_for_change(const std::shared_ptr<const HeldMap>& before, SteadyTime deadline) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
