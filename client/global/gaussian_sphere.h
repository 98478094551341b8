// The Gaussian sphere: the unit sphere about the camera's centre. A line of an image becomes a
// great circle on it, and parallel lines of the world circles that meet in their vanishing
// direction (the aerial paper, section III, and Barnard, 1983).
//
// Directions are unit vectors in the camera frame: x to the right, y down, z forward. A vanishing
// direction and its opposite are one and the same.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "client/global/line_segments.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// Pixels count from the centre of the top left one. REQUIRES: focal lengths above 0.
Eigen::Vector3d direction_of_pixel(const Pinhole& view, const Eigen::Vector2d& pixel);

// How far a detected line is from the edge of the world that it stands for.
struct LineNoise {
  double end_px = 0.4;    // of each end, across the line
  double bend_deg = 0.3;  // of the edge itself: walls and lenses are not quite straight
};

// The great circle of a line segment, with the two ways in which noise moves it: it turns about
// the segment's middle, and shifts across the segment.
struct GreatCircle {
  Eigen::Vector3d normal;  // unit, to the plane through the camera's centre and the line
  Eigen::Vector3d middle;  // unit, on the circle: towards the segment's middle
  Eigen::Vector3d along;   // unit, on the circle, a quarter of it from the middle
  double turn_sigma_rad = 0;
  double shift_sigma_rad = 0;

  // Between the circle and the direction, 0 to pi / 2, in radians.
  double arc_distance_rad(const Eigen::Vector3d& direction) const;

  // Standard deviation of normal . direction, for a direction the circle passes through.
  double sigma_rad(const Eigen::Vector3d& direction) const;
};

// REQUIRES: the segment's ends differ.
GreatCircle great_circle(const Pinhole& view, const LineSegment& segment, const LineNoise& noise);
std::vector<GreatCircle> great_circles(const Pinhole& view, std::span<const LineSegment> segments,
                                       const LineNoise& noise);

// Where the circles meet, pair by pair, one of the two opposite points each: the one with y < 0,
// above the camera. Pairs that all but coincide, within `min_angle_rad`, are left out.
std::vector<Eigen::Vector3d> intersections(std::span<const GreatCircle> circles,
                                           double min_angle_rad);

}  // namespace milepost
