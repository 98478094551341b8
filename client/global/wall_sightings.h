// What a frame tells of walls: their orientations by bearing (the aerial paper, sections III, IV).
#pragma once

#include <optional>
#include <vector>

#include "client/global/vanishing_directions.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// Angles are clockwise from the camera's heading. An orientation and its opposite are the same.
struct BearingRange {
  double from_rad = 0;
  double to_rad = 0;  // > from_rad

  double width_rad() const { return to_rad - from_rad; }
  double middle_rad() const { return (from_rad + to_rad) / 2; }
};

// The paper's view section e: the bearings within which the same orientations are seen.
struct ViewSection {
  BearingRange bearings;
  std::vector<double> orientations_rad;  // psi_s,i: of the walls in view there; not empty
};

// The rotation that takes directions of the camera frame to a camera that stands upright: about z
// and x only, so that the heading stays. Identity where no vertical was found.
Eigen::Matrix3d level_from_camera(const VanishingDirections& found);

// The sections of a view, from left to right, without those in which nothing is seen. Of the lines
// that belong to a horizontal direction, those that reach above the horizon count: below it are
// the road's.
std::vector<ViewSection> view_sections(const VanishingDirections& found, const Pinhole& view);

}  // namespace milepost
