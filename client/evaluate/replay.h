// Plays a recorded drive to localizers, frame by frame, as a vehicle would live it.
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
  std::vector<std::vector<FrameFix>> fixes;  // by method, then by frame: one a frame
  std::optional<Error> outage;               // a failure of the source that was driven through
};

// Localizes every frame by every method; a method sees nothing of another, but features are
// extracted once a frame and their time is counted to each. Receiver positions (gps.csv) are handed
// on when their time has come; recorded positions of frames are never looked at.
// `with_estimates` keeps what each tracklet said in each frame. `on_frame` is called with the
// number of frames done, and now and then while the map is waited for; false stops the replay
// (cancelled). Errors: those of FrameReader::gray; those of Localizer::localize but unavailable
// before a method's first fix; invalid_input for a drive without gps.csv.
Result<Replay> replay_drive(const Drive& drive, const std::shared_ptr<MapSource>& source,
                            const std::vector<Method>& methods, bool with_estimates,
                            const std::function<bool(std::size_t)>& on_frame);

}  // namespace milepost
