// From an image to the directions of the edges of buildings (the aerial paper, section III): the
// vertical, and the horizontal ones, which are the orientations of walls. Our way (decision 20):
// lines vote by their noise, and the directions are refined together.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "client/global/direction_search.h"
#include "client/global/gaussian_sphere.h"
#include "client/global/line_segments.h"
#include "schema/geo/pinhole.h"

namespace milepost {

enum class Orientation { vertical, horizontal };

struct VanishingSettings {
  double min_length_px = 20;  // of a line segment
  double max_tilt_deg = 40;   // of the camera against the vertical, roll and pitch together
  LineNoise noise;
  std::size_t max_horizontal = 3;
};

struct VanishingDirection {
  Eigen::Vector3d direction;  // unit, in the camera frame; up for the vertical, else z >= 0
  Orientation orientation = Orientation::horizontal;
  std::size_t lines = 0;  // that belong to it
};

struct VanishingLine {
  LineSegment segment;
  std::optional<std::size_t> direction;  // index into directions; none for a line left out
};

struct VanishingDirections {
  std::vector<VanishingDirection> directions;  // the vertical first, if found, then by evidence
  std::vector<VanishingLine> lines;            // the longest first
};

// REQUIRES: segments as line_segments() returns them, of pixels of the view.
VanishingDirections vanishing_directions(std::span<const LineSegment> segments, const Pinhole& view,
                                         const VanishingSettings& settings = {});

// The same image and settings give the same answer, to the bit. Safe from several threads.
// REQUIRES: `gray` is CV_8UC1 and not empty.
VanishingDirections vanishing_directions(const cv::Mat& gray, const Pinhole& view,
                                         const VanishingSettings& settings = {});

// What other ways to find them share:
// Where a vertical and where a horizontal direction may be, of a camera that is tilted no more.
Zone vertical_zone(const VanishingSettings& settings);
Zone horizontal_zone(const VanishingSettings& settings);
// Turned to the side that VanishingDirection names.
VanishingDirection vanishing_direction(const Eigen::Vector3d& direction, Orientation orientation);
// How far a line is off a direction: from 1 on it is not of it.
using RelativeMisfit = std::function<double(const GreatCircle&, const Eigen::Vector3d& direction)>;
// The directions with their lines, each the one's that it misfits least. `circles` are the
// segments' own.
VanishingDirections with_lines(std::span<const LineSegment> segments,
                               std::span<const GreatCircle> circles,
                               std::vector<VanishingDirection> directions,
                               const RelativeMisfit& misfit);

}  // namespace milepost
