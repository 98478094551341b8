// The localizer: frames, GNSS fixes and odometry in, fixes out.
#pragma once

#include <memory>
#include <optional>

#include "client/fetch/map_source.h"
#include "client/fetch/stopped.h"
#include "client/fetch/tile_provider.h"
#include "client/localize/expected_route.h"
#include "client/localize/fix.h"
#include "client/localize/gnss_fix.h"
#include "client/localize/localizer_settings.h"
#include "client/localize/query.h"
#include "schema/geo/camera.h"
#include "schema/geo/odometry.h"

namespace milepost {

// Not safe to use from several threads at once. Background threads of the localizer load the map: a
// frame uses the data that has arrived and waits for nothing.
class Localizer {
 public:
  Localizer(const std::shared_ptr<MapSource>& source, const Camera& camera,
            const LocalizerSettings& settings);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  // Adds a GNSS fix; of several the latest is used.
  void observe(const GnssFix& position);

  // Adds an odometry reading; methods that use odometry (milepost) propagate the pose with it
  // between frames. Pass each reading before the first frame with a later timestamp. Readings that
  // are not finite or not ascending in time are ignored.
  void observe(const Odometry& odometry);

  // Sets the route that decides which branches are fetched first; it is no evidence of where the
  // vehicle is.
  void expect(ExpectedRoute route);

  // The fix of the next frame, by the map data held. REQUIRES: timestamps ascend strictly. Errors:
  // those of the map source while there is no map data to continue with (unavailable, corrupt,
  // ...); invalid_input if the map lacks the method's layer. The localizer remains usable: the next
  // frame may succeed. While tracking, a failing source is recorded in last_error() and
  // localization continues without it.
  Result<Fix> localize(const QueryFrame& frame);

  // The latest fix propagated by the estimated motion to a time after its frame. REQUIRES: not
  // before the latest frame.
  Fix fix_at(double timestamp_s) const;

  // The map data held and wanted.
  const TileProvider& provider() const;

  // The latest error of the source that did not stop localize().
  const std::optional<Error>& last_error() const;

  // For reproducible replays of recorded drives: blocks until the map data that a frame at that
  // time needs is held or its request has failed, until `deadline`, or until stopped. Returns
  // whether the data is settled.
  bool wait_for_tiles(double timestamp_s, SteadyTime deadline, const Stopped& stopped = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
