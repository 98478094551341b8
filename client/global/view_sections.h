// The orientations of visible walls by bearing (the aerial paper, sections III, IV).
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

// The paper's view section e: a range of bearings with the same visible orientations.
struct ViewSection {
  BearingRange bearings;
  std::vector<double> orientations_rad;  // psi_s,i: of the visible walls; not empty
};

// The rotation from the camera frame to that of an upright camera: about z and x only, so that the
// heading stays. Identity if no vertical direction was found.
Eigen::Matrix3d level_from_camera(const VanishingDirections& found);

// The sections of a view from left to right, without those in which no orientation is visible. Only
// lines of horizontal directions that reach above the horizon count: lines below it belong to the
// road.
std::vector<ViewSection> view_sections(const VanishingDirections& found, const Pinhole& view);

}  // namespace milepost
