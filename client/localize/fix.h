// The answer of a localizer for one frame.
#pragma once

#include <optional>
#include <string>

#include "client/fetch/map_source.h"
#include "client/localize/tracked_position.h"
#include "schema/geo/geodesy.h"

namespace milepost {

enum class FixStatus {
  initializing,  // not yet sure where: a fix there may be is as wide as that
  tracking,      // this frame was measured against the map
  predicted,  // this frame gave no measurement, or spoke against the place; the motion carries on
  lost,       // the place is given up; looking again around the last fix or the receiver
  off_map,    // no segment is near, or the vehicle drove over an end of its segment
};

const char* name_of(FixStatus status);

struct Fix {
  double timestamp_s = 0;
  FixStatus status = FixStatus::initializing;
  MapVersion version;             // empty unless a segment is known
  std::string segment;            // empty unless known
  std::optional<double> along_m;  // [0, length of the segment]
  // One standard deviation, with along_m; until a place is claimed of all that it may be about
  // here.
  double sigma_m = 0;
  // Only of methods that know the camera's pose, not just its along:
  std::optional<double> lateral_m;        // from the segment's line, positive to the right
  std::optional<double> lateral_sigma_m;  // one standard deviation
  std::optional<double> heading_deg;      // of the camera, clockwise from north, [0, 360)
  // Where the camera is: beside the line where its lateral is known, else on it, at along_m.
  std::optional<GeoPoint> position;
  std::optional<CameraPlacement> camera;  // ... in six degrees of freedom
  int matches = 0;                        // features that agreed on the measurement
};

}  // namespace milepost
