// The Gaussian sphere: the unit sphere around the camera's centre. A line in the image corresponds
// to a great circle on it, and parallel lines in the world to circles that intersect in their
// vanishing direction (the aerial paper, section III, and Barnard, 1983).
//
// Directions are unit vectors in the camera frame: x to the right, y down, z forward. A vanishing
// direction and its opposite are equivalent.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "client/global/line_segments.h"
#include "schema/geo/pinhole.h"

namespace milepost {

// Pixel coordinates have their origin at the centre of the top left pixel. REQUIRES: focal lengths
// above 0.
Eigen::Vector3d direction_of_pixel(const Pinhole& view, const Eigen::Vector2d& pixel);

// The noise of a detected line relative to the edge in the world.
struct LineNoise {
  double end_px = 0.4;    // of each end, perpendicular to the line
  double bend_deg = 0.3;  // of the edge itself: walls and imaging are not perfectly straight
};

// The great circle of a line segment with its two noise components: a rotation about the segment's
// middle and a shift perpendicular to the segment.
struct GreatCircle {
  Eigen::Vector3d normal;  // unit normal of the plane through the camera's centre and the line
  Eigen::Vector3d middle;  // unit, on the circle: towards the segment's middle
  Eigen::Vector3d along;   // unit, on the circle, 90 degrees from `middle`
  double turn_sigma_rad = 0;
  double shift_sigma_rad = 0;

  // The angle between the circle and the direction, in [0, pi / 2] radians.
  double arc_distance_rad(const Eigen::Vector3d& direction) const;

  // The standard deviation of normal . direction for a direction on the circle.
  double sigma_rad(const Eigen::Vector3d& direction) const;
};

// REQUIRES: the ends of the segment differ.
GreatCircle great_circle(const Pinhole& view, const LineSegment& segment, const LineNoise& noise);
std::vector<GreatCircle> great_circles(const Pinhole& view, std::span<const LineSegment> segments,
                                       const LineNoise& noise);

// The pairwise intersections of the circles. Of the two opposite points the one with y < 0, above
// the camera, is returned. Pairs at less than `min_angle_rad` to each other are omitted.
std::vector<Eigen::Vector3d> intersections(std::span<const GreatCircle> circles,
                                           double min_angle_rad);

}  // namespace milepost
