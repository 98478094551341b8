// Plays a recorded drive to a finder, frame by frame, and to a route localizer that starts from
// what it finds.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/evaluate/evaluation.h"
#include "client/fetch/map_source.h"
#include "client/global/finder.h"
#include "schema/drive/drive.h"

namespace milepost {

struct FoundFrame {
  std::string filename;
  FindFix fix;
  double latency_ms = 0;
};

struct FoundDrive {
  std::vector<FoundFrame> frames;   // one a frame
  std::vector<FrameFix> localized;  // the same of the route localizer; empty without one
  std::optional<Error> outage;      // a failure of its source that was driven through
};

struct FindRun {
  FinderSettings finder;
  // Not empty: a localizer of the default method runs beside the finder on this source, and has
  // nothing to start from but what is found.
  std::shared_ptr<MapSource> localizer_source;
  Stopped stopped = {};  // asked while the localizer's map is waited for
  // Called after each frame with its number, from 0, and what was found in it; false stops the run
  // (cancelled).
  std::function<bool(std::size_t frame, const FindFix& fix, const Finder& finder)> on_frame;
};

// Recorded positions of frames and the receiver's are never looked at. Errors: those of
// FrameReader::gray; invalid_input for a drive without odometry.csv; those of a map that the
// localizer cannot use.
Result<FoundDrive> find_drive(const Drive& drive, const std::vector<Wall>& walls,
                              const FindRun& run);

}  // namespace milepost
