#include "mapper/fusion/pose_error.h"

#include <cmath>

namespace milepost {

RoadPlace road_place(const RouteLine& line, double along_m) {
  const double heading_rad = line.heading_deg_at(along_m) * kRadPerDeg;
  return {LocalFrame(line.point_at(along_m)), {std::sin(heading_rad), std::cos(heading_rad), 0}};
}

}  // namespace milepost
