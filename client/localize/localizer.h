// The localizer: frames and coarse positions in, fixes out.
#pragma once

#include <memory>
#include <optional>

#include "client/fetch/backoff.h"
#include "client/fetch/map_source.h"
#include "client/fetch/provider_state.h"
#include "client/fetch/stopped.h"
#include "client/fetch/tile_provider.h"
#include "client/localize/coarse_position.h"
#include "client/localize/fix.h"
#include "client/localize/landmark_method.h"
#include "client/localize/place_odds.h"
#include "client/localize/query.h"
#include "client/localize/receiver_evidence.h"
#include "schema/geo/odometry.h"
#include "schema/geo/pinhole.h"

namespace milepost {

struct LocalizerSettings {
  Method method = landmark_method();
  double start_radius_m = 30;   // segments farther from the coarse position are not looked at
  double start_sigmas = 3;      // of the coarse position, searched along the segment
  double start_reach_m = 5;     // ... and so much more
  double max_coarse_age_s = 3;  // older positions start and contradict nothing
  PlaceOddsSettings odds;
  ReceiverEvidenceSettings receiver;
  int max_places = 5;            // that are weighed against each other
  int max_predicted_frames = 8;  // frames without measurement before the vehicle counts as lost
  double prefetch_m = 300;       // wanted ahead
  ScoutSettings scout;
  ProviderSettings provider;
};

// Not safe to use from several threads at once. The map comes by threads of the localizer's own:
// a frame takes what has arrived, and waits for nothing.
class Localizer {
 public:
  Localizer(const std::shared_ptr<MapSource>& source, const Camera& camera,
            const LocalizerSettings& settings);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  // What the receiver says; of several the latest counts.
  void observe(const CoarsePosition& position);

  // What the wheels say, of methods that carry on by them (milepost) the motion between frames. A
  // reading is told before the first frame that is later than it; readings ascend, and others are
  // left out.
  void observe(const Odometry& odometry);

  // The fix of the next frame, by what is held of the map. REQUIRES: timestamps ascend strictly.
  // Errors: what the map source says when there is nothing to go on with (unavailable, corrupt,
  // ...), and invalid_input where the map lacks the method's layer. The localizer stays usable: the
  // next frame may succeed. Once tracking, a source that fails is noted and driven on without.
  Result<Fix> localize(const QueryFrame& frame);

  // Where the latest fix has come to by a time after its frame, as the motion is known.
  // REQUIRES: not before the latest frame.
  Fix fix_at(double timestamp_s) const;

  // What is held and wanted of the map.
  const TileProvider& provider() const;

  // The latest failure of the source that did not keep localize() from answering.
  const std::optional<Error>& noted_error() const;

  // For replays of recorded drives, so that their fixes are the same each time: waits until what
  // a frame of that time needs of the map is held or was asked for in vain, at the latest until
  // `deadline`, or until it is stopped. Whether it is so.
  bool wait_for_tiles(double timestamp_s, SteadyTime deadline, const Stopped& stopped = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
