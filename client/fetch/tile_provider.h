// Brings what a vehicle wants of the map into memory, beside the frames: no frame ever waits.
#pragma once

#include <memory>
#include <string>

#include "client/fetch/held_map.h"
#include "client/fetch/map_source.h"
#include "client/fetch/provider_state.h"
#include "client/fetch/wants.h"

namespace milepost {

// Two threads of its own: one reads the cache or the file, one asks the network, so that what is
// stored never waits for a server. What fails is asked for again, later each time. All members may
// be called from any thread; none waits for a thread that works, but wait_for_change().
class TileProvider {
 public:
  // Of one layer of the source's maps.
  TileProvider(const std::shared_ptr<MapSource>& source, std::string layer,
               const ProviderSettings& settings = {});
  // Ends within a second, whatever the source does.
  ~TileProvider();
  TileProvider(const TileProvider&) = delete;
  TileProvider& operator=(const TileProvider&) = delete;

  // Replaces what was wanted.
  void want(Wants wants);
  Wants wanted() const;
  // What has arrived by now.
  std::shared_ptr<const HeldMap> held() const;

  // Whether all that is wanted is held, or was asked for in vain.
  bool is_settled() const;
  // For replays of recorded drives: waits until it is settled, or until something has arrived since
  // `before`, for which more may be wanted, or until `deadline`.
  void wait_for_change(const std::shared_ptr<const HeldMap>& before, SteadyTime deadline) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
