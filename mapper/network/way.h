// Driven lines as states one metre apart, which is what roads are compared by.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "mapper/network/driven_line.h"

namespace milepost {

// Where a vehicle was and where it went. Geocentric, so that no choice of a local frame, which a
// drive elsewhere might change, plays a part.
struct RoadState {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // on the ellipsoid
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();     // unit length, along the way
  double altitude_m = 0;
};

// One driven line. Its states lie at 0, 1, 2, ... m along it: a state's index is its metre.
struct Way {
  std::size_t drive = 0;    // index of the drive that it belongs to
  std::size_t stretch = 0;  // index of the driven line in the drive
  double begin_m = 0;       // of the line, along the whole drive's forward way
  double length_m = 0;
  bool has_altitudes = false;  // an altitude other than 0 occurs
  std::vector<RoadState> states;
};

// The ways of one drive. Positions are means over 7 m and directions over 13 m, which evens out
// noise of 0.3 m and shifts a lane's line in the tightest turns by 0.3 m.
std::vector<Way> ways_of(const NamedDrivenLines& drive, std::size_t drive_index);

// A place on a way. Places are ordered by way, then along it.
struct Place {
  std::size_t way = 0;  // index
  double along_m = 0;

  friend bool operator<(const Place& a, const Place& b) {
    return a.way != b.way ? a.way < b.way : a.along_m < b.along_m;
  }
};

// The index of the state nearest to a place.
std::size_t nearest_state(const Way& way, double along_m);

}  // namespace milepost
