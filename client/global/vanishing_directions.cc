#include "client/global/vanishing_directions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

const Eigen::Vector3d kCameraUp(0, -1, 0);

constexpr std::size_t kVotingLines = 60;
constexpr double kMinLogLikelihoodRatio = 20;       // nats: six to eight good lines
constexpr double kMinApartRad = 15 * kRadPerDeg;    // of two horizontal directions
constexpr double kBandRad = 5 * kRadPerDeg;         // around the detected horizon
constexpr double kSquareSigmaRad = 1 * kRadPerDeg;  // of horizontal against vertical edges
constexpr int kJointRefinements = 3;

using Directions = std::vector<VanishingDirection>;

Eigen::Vector3d oriented(const Eigen::Vector3d& direction, Orientation orientation) {
  const bool turn = orientation == Orientation::vertical ? direction.y() > 0 : direction.z() < 0;
  return turn ? Eigen::Vector3d(-direction) : direction;
}

// The circles that fit none of the directions.
std::vector<GreatCircle> unexplained(std::span<const GreatCircle> circles,
                                     const Directions& directions) {
  std::vector<GreatCircle> rest;
  for (const GreatCircle& circle : circles) {
    const bool is_explained =
        std::any_of(directions.begin(), directions.end(), [&](const VanishingDirection& direction) {
          return misfit_sigmas(circle, direction.direction) < kMaxMisfitSigmas;
        });
    if (!is_explained) rest.push_back(circle);
  }
  return rest;
}

// The directions perpendicular to direction `index`: the vertical one to horizontal ones and vice
// versa.
std::vector<SquareTo> square_to(const Directions& directions, std::size_t index) {
  std::vector<SquareTo> known;
  for (const VanishingDirection& other : directions) {
    if (other.orientation == directions[index].orientation) continue;
    known.push_back({other.direction, kSquareSigmaRad});
  }
  return known;
}

void refine_together(std::span<const GreatCircle> circles, Directions& directions) {
  for (int round = 0; round < kJointRefinements; ++round) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      VanishingDirection& direction = directions[i];
      direction.direction =
          oriented(refined_direction(circles, square_to(directions, i), direction.direction),
                   direction.orientation);
    }
  }
}

bool apart_from_all(const Directions& directions, const Eigen::Vector3d& direction) {
  return std::all_of(directions.begin(), directions.end(), [&](const VanishingDirection& other) {
    return std::abs(other.direction.dot(direction)) < std::cos(kMinApartRad);
  });
}

Directions directions_by_likelihood(std::span<const GreatCircle> circles,
                                    const VanishingSettings& settings) {
  Directions directions;
  const Zone pole = vertical_zone(settings);
  const auto vertical = strongest_direction(
      circles, kVotingLines,
      [&](const Eigen::Vector3d& direction) { return pole.contains(direction); });
  Zone horizon = horizontal_zone(settings);
  if (vertical && likelihood(circles, *vertical) >= kMinLogLikelihoodRatio) {
    directions.push_back(
        vanishing_direction(refined_direction(circles, {}, *vertical), Orientation::vertical));
    horizon = {directions.front().direction, 90 * kRadPerDeg - kBandRad, 90 * kRadPerDeg};
  }
  for (std::size_t found = 0; found < settings.max_horizontal; ++found) {
    const std::vector<GreatCircle> rest = unexplained(circles, directions);
    const auto strongest =
        strongest_direction(rest, kVotingLines, [&](const Eigen::Vector3d& direction) {
          return horizon.contains(direction) && apart_from_all(directions, direction);
        });
    if (!strongest || likelihood(rest, *strongest) < kMinLogLikelihoodRatio) break;
    directions.push_back(vanishing_direction(*strongest, Orientation::horizontal));
    refine_together(circles, directions);
  }
  return directions;
}

std::optional<std::size_t> nearest_direction(const GreatCircle& circle,
                                             const Directions& directions,
                                             const RelativeMisfit& misfit) {
  std::optional<std::size_t> nearest;
  double least = 1;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double off = misfit(circle, directions[i].direction);
    if (off >= least) continue;
    least = off;
    nearest = i;
  }
  return nearest;
}

}  // namespace

Zone vertical_zone(const VanishingSettings& settings) {
  return {kCameraUp, 0, settings.max_tilt_deg * kRadPerDeg};
}

Zone horizontal_zone(const VanishingSettings& settings) {
  return {kCameraUp, (90 - settings.max_tilt_deg) * kRadPerDeg, 90 * kRadPerDeg};
}

VanishingDirection vanishing_direction(const Eigen::Vector3d& direction, Orientation orientation) {
  return {oriented(direction, orientation), orientation, 0};
}

VanishingDirections with_lines(std::span<const LineSegment> segments,
                               std::span<const GreatCircle> circles,
                               std::vector<VanishingDirection> directions,
                               const RelativeMisfit& misfit) {
  VanishingDirections found{std::move(directions), {}};
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto direction = nearest_direction(circles[i], found.directions, misfit);
    if (direction) ++found.directions[*direction].lines;
    found.lines.push_back({segments[i], direction});
  }
  return found;
}

VanishingDirections vanishing_directions(std::span<const LineSegment> segments, const Pinhole& view,
                                         const VanishingSettings& settings) {
  const std::vector<GreatCircle> circles = great_circles(view, segments, settings.noise);
  return with_lines(segments, circles, directions_by_likelihood(circles, settings),
                    [](const GreatCircle& circle, const Eigen::Vector3d& direction) {
                      return misfit_sigmas(circle, direction) / kMaxMisfitSigmas;
                    });
}

VanishingDirections vanishing_directions(const cv::Mat& gray, const Camera& camera,
                                         const VanishingSettings& settings) {
  return vanishing_directions(undistorted(line_segments(gray, settings.min_length_px), camera),
                              camera.pinhole, settings);
}

}  // namespace milepost
