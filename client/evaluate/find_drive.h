// Replays a recorded drive to a global localizer, frame by frame, and optionally to a localizer
// along roads that starts from its estimates.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "client/fetch/map_source.h"
#include "client/global/global_localizer.h"
#include "schema/drive/drive.h"

namespace milepost {

struct FoundFrame {
  std::string filename;
  GlobalPoseEstimate fix;
  double latency_ms = 0;
};

struct FoundDrive {
  std::vector<FoundFrame> frames;   // one per frame
  std::vector<FrameFix> localized;  // of the localizer along roads; empty without one
  std::optional<Error> outage;      // an error of its source that did not stop the run
};

struct FindRun {
  GlobalLocalizerSettings localizer;
  // If set, a localizer with the default method runs on this source in parallel and starts from the
  // global fixes only.
  std::shared_ptr<MapSource> localizer_source;
  Stopped stopped = {};  // polled while waiting for the localizer's map data
  // Called after each frame with its number, from 0, and its estimate; returning false stops the
  // run (cancelled).
  std::function<bool(std::size_t frame, const GlobalPoseEstimate& fix,
                     const GlobalLocalizer& localizer)>
      on_frame;
};

// Recorded positions of frames and GNSS fixes are ignored. Errors: those of FrameReader::gray;
// invalid_input for a drive without odometry.csv; those of a map that the localizer cannot use.
Result<FoundDrive> find_drive(const Drive& drive, const std::vector<Wall>& walls,
                              const FindRun& run);

}  // namespace milepost
