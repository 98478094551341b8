#include "mapper/findings/steps.h"

#include <cmath>

#include "schema/base/median.h"

namespace milepost {

GeoAttitude recorded_pose(const Drive& drive, const Frame& frame) {
  return vehicle_of_camera({frame.position, frame.heading_deg, frame.pitch_deg, frame.roll_deg},
                           drive.camera.mounting);
}

std::vector<Step> steps_of(const Drive& drive) {
  std::vector<Step> steps;
  for (std::size_t i = 0; i + 1 < drive.frames.size(); ++i) {
    const Frame& from = drive.frames[i];
    const Frame& to = drive.frames[i + 1];
    const EnuPoint way = LocalFrame(recorded_pose(drive, from).position)
                             .enu_from_geo(recorded_pose(drive, to).position);
    steps.push_back({i, {way.east_m, way.north_m, way.up_m}, to.timestamp_s - from.timestamp_s});
  }
  return steps;
}

double noise_of(const std::vector<double>& off_neighbours) {
  constexpr std::size_t kFewest = 8;
  if (off_neighbours.size() < kFewest) return 0;
  std::vector<double> changes;
  for (std::size_t i = 0; i + 1 < off_neighbours.size(); ++i)
    changes.push_back(off_neighbours[i + 1] - off_neighbours[i]);
  // Of four values with weights 1/2, 3/2, 3/2, 1/2.
  return robust_sigma_of(changes) / std::sqrt(5.0);
}

}  // namespace milepost
