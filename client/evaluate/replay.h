// Replays a recorded drive to localizers, frame by frame, as in a vehicle.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "client/fetch/map_source.h"
#include "client/localize/localizer.h"
#include "schema/drive/drive.h"

namespace milepost {

struct Replay {
  std::vector<std::vector<FrameFix>> fixes;  // by method, then by frame
  std::optional<Error> outage;               // an error of the source that did not stop the replay
};

// Localizes every frame with every method. Methods are independent, but features are extracted once
// per frame and their time is added to each method. GNSS fixes (gps.csv) are passed on when their
// time has come; recorded positions of frames are ignored. `with_estimates` keeps the estimates of
// each tracklet in each frame. `on_frame` is called with the number of frames done, and repeatedly
// while waiting for the map; returning false stops the replay (cancelled). Errors: those of
// FrameReader::gray; before a method's first fix those of Localizer::localize, except unavailable
// if waiting may help; invalid_input for a drive without gps.csv.
Result<Replay> replay_drive(const Drive& drive, const std::shared_ptr<MapSource>& source,
                            const std::vector<Method>& methods, bool with_estimates,
                            const std::function<bool(std::size_t)>& on_frame);

}  // namespace milepost
