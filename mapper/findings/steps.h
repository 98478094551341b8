// The way between the recorded positions of a drive's frames.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "schema/drive/drive.h"

namespace milepost {

// From one frame to the next.
struct Step {
  std::size_t from = 0;   // index of its first frame
  Eigen::Vector3d way_m;  // east, north, up in the tangent frame there
  double elapsed_s = 0;

  double length_m() const { return way_m.head<2>().norm(); }
};

// Below this a step's direction tells nothing.
inline constexpr double kLeastStepM = 0.3;

// The pose of a frame as it was recorded: the camera's, or with a mounting the vehicle's.
GeoAttitude recorded_pose(const Drive& drive, const Frame& frame);

std::vector<Step> steps_of(const Drive& drive);

// The standard deviation of noise from frame to frame, by how far each value lies from the mean of
// its two neighbours, weighted by time: a steady curve is the same for all of these and cancels in
// their differences. 0 if there are fewer than 8.
double noise_of(const std::vector<double>& off_neighbours);

}  // namespace milepost
