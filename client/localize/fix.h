// The result of a localizer for one frame.
#pragma once

#include <optional>
#include <string>

#include "client/fetch/map_source.h"
#include "client/localize/tracked_pose.h"
#include "schema/geo/geodesy.h"

namespace milepost {

enum class FixStatus {
  initializing,  // the hypotheses are not decided yet: the sigmas of a fix cover all of them
  tracking,      // this frame was measured against the map
  predicted,     // no measurement, or one that contradicts the pose: propagated by the motion
  lost,          // the hypothesis was rejected, and its motion does not tell where it is now;
                 // relocalizing around the last fix or the GNSS fix
  off_map,       // no segment is near, or the vehicle drove past an end of its segment
};

const char* name_of(FixStatus status);

struct Fix {
  double timestamp_s = 0;
  FixStatus status = FixStatus::initializing;
  MapVersion version;             // empty unless a segment is known
  std::string segment;            // empty unless known
  std::optional<double> along_m;  // [0, length of the segment]
  // One standard deviation of along_m in the world, where the map has an error of its own; until a
  // hypothesis is accepted, of all hypotheses and elsewhere; off the map, of the position in plan.
  double sigma_m = 0;
  double sigma_map_m = 0;  // the same against the map, as if its positions were exact
  // Only of methods that estimate the camera's pose, not just its arc length:
  std::optional<double> lateral_m;        // from the segment's line, positive to the right
  std::optional<double> lateral_sigma_m;  // one standard deviation, in the world
  std::optional<double> heading_deg;      // of the camera, clockwise from north, [0, 360)
  // Position of the camera; where its lateral offset is unknown, on the line at along_m. Off the
  // map where its motion has carried it, as long as that is known to some 30 m.
  std::optional<GeoPoint> position;
  std::optional<GeoCameraPose> camera;  // the pose in six degrees of freedom, in the world
  int matches = 0;                      // inlier features of the measurement
};

}  // namespace milepost
