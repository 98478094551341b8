// The vanishing directions of building edges in an image (the aerial paper, section III): the
// vertical one and the horizontal ones, which are the orientations of walls. Ours (decision 20):
// lines vote by their noise, and the directions are refined jointly.
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
  double max_tilt_deg = 40;   // of the camera from upright, roll and pitch combined
  LineNoise noise;
  std::size_t max_horizontal = 3;
};

struct VanishingDirection {
  Eigen::Vector3d direction;  // unit, in the camera frame; up for the vertical, else z >= 0
  Orientation orientation = Orientation::horizontal;
  std::size_t lines = 0;  // number of its lines
};

struct VanishingLine {
  LineSegment segment;
  std::optional<std::size_t> direction;  // index into directions; none for an outlier
};

struct VanishingDirections {
  std::vector<VanishingDirection> directions;  // the vertical first, if found, then by likelihood
  std::vector<VanishingLine> lines;            // the longest first
};

// REQUIRES: segments as returned by undistorted(), in pixels of the view.
VanishingDirections vanishing_directions(std::span<const LineSegment> segments, const Pinhole& view,
                                         const VanishingSettings& settings = {});

// Deterministic, to the bit. Safe to call from several threads at once. REQUIRES: `gray` is CV_8UC1
// and not empty. The lines are told in pixels of the camera's pinhole.
VanishingDirections vanishing_directions(const cv::Mat& gray, const Camera& camera,
                                         const VanishingSettings& settings = {});

// Shared with other methods of finding them: The zones of vertical and horizontal directions for a
// camera within the maximum tilt.
Zone vertical_zone(const VanishingSettings& settings);
Zone horizontal_zone(const VanishingSettings& settings);
// With the sign that VanishingDirection defines.
VanishingDirection vanishing_direction(const Eigen::Vector3d& direction, Orientation orientation);
// The misfit of a line to a direction, relative to the threshold: from 1 on the line does not
// belong to it.
using RelativeMisfit = std::function<double(const GreatCircle&, const Eigen::Vector3d& direction)>;
// The directions with their lines; each line is assigned to the direction with the smallest misfit.
// `circles` are those of the segments.
VanishingDirections with_lines(std::span<const LineSegment> segments,
                               std::span<const GreatCircle> circles,
                               std::vector<VanishingDirection> directions,
                               const RelativeMisfit& misfit);

}  // namespace milepost
