#include "client/global/vanishing_directions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/global/direction_search.h"
#include "client/global/subtractive_clustering.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

const Eigen::Vector3d kCameraUp(0, -1, 0);

// The paper's way. Pairs of more lines than these make clustering slow and hardly better.
constexpr std::size_t kClusteredLines = 90;
constexpr double kMaxArcDistanceRad = 4 * kRadPerDeg;

// Ours.
constexpr std::size_t kVotingLines = 60;
constexpr double kMinEvidence = 20;                 // nats: six to eight good lines
constexpr double kMinApartRad = 15 * kRadPerDeg;    // of two horizontal directions
constexpr double kBandRad = 5 * kRadPerDeg;         // horizontal directions about the found horizon
constexpr double kSquareSigmaRad = 1 * kRadPerDeg;  // of walls: their level edges on the vertical
constexpr int kJointRefinements = 3;

using Directions = std::vector<VanishingDirection>;

Eigen::Vector3d oriented(const Eigen::Vector3d& direction, Orientation orientation) {
  const bool turn = orientation == Orientation::vertical ? direction.y() > 0 : direction.z() < 0;
  return turn ? Eigen::Vector3d(-direction) : direction;
}

void add(Directions& directions, const Eigen::Vector3d& direction, Orientation orientation) {
  directions.push_back({oriented(direction, orientation), orientation, 0});
}

Directions by_clustering(std::span<const GreatCircle> circles, const VanishingSettings& settings) {
  const Zone pole{kCameraUp, 0, settings.max_tilt_deg * kRadPerDeg};
  const Zone equator{kCameraUp, (90 - settings.max_tilt_deg) * kRadPerDeg, 90 * kRadPerDeg};
  std::vector<Eigen::Vector3d> polar;
  std::vector<Eigen::Vector3d> equatorial;
  const auto longest = circles.first(std::min(kClusteredLines, circles.size()));
  for (const Eigen::Vector3d& point : intersections(longest, 0.5 * kRadPerDeg)) {
    if (pole.contains(point)) polar.push_back(point);
    if (equator.contains(point)) equatorial.push_back(point);
  }
  Directions directions;
  ClusteringSettings clustering;
  clustering.max_centres = 1;
  for (const auto& centre : cluster_centres(polar, clustering)) {
    add(directions, centre, Orientation::vertical);
  }
  clustering.max_centres = settings.max_horizontal;
  for (const auto& centre : cluster_centres(equatorial, clustering)) {
    add(directions, centre, Orientation::horizontal);
  }
  return directions;
}

// Circles that no direction passes through.
std::vector<GreatCircle> unexplained(std::span<const GreatCircle> circles,
                                     const Directions& directions) {
  std::vector<GreatCircle> rest;
  for (const GreatCircle& circle : circles) {
    const bool explained =
        std::any_of(directions.begin(), directions.end(), [&](const VanishingDirection& direction) {
          return misfit_sigmas(circle, direction.direction) < kMaxMisfitSigmas;
        });
    if (!explained) rest.push_back(circle);
  }
  return rest;
}

// The directions that `index` is square to: the horizontal ones to the vertical, and it to them.
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

Directions by_evidence(std::span<const GreatCircle> circles, const VanishingSettings& settings) {
  Directions directions;
  const Zone pole{kCameraUp, 0, settings.max_tilt_deg * kRadPerDeg};
  const auto vertical = strongest_direction(
      circles, kVotingLines,
      [&](const Eigen::Vector3d& direction) { return pole.contains(direction); });
  Zone horizon{kCameraUp, (90 - settings.max_tilt_deg) * kRadPerDeg, 90 * kRadPerDeg};
  if (vertical && evidence(circles, *vertical) >= kMinEvidence) {
    add(directions, refined_direction(circles, {}, *vertical), Orientation::vertical);
    horizon = {directions.front().direction, 90 * kRadPerDeg - kBandRad, 90 * kRadPerDeg};
  }
  for (std::size_t found = 0; found < settings.max_horizontal; ++found) {
    const std::vector<GreatCircle> rest = unexplained(circles, directions);
    const auto strongest =
        strongest_direction(rest, kVotingLines, [&](const Eigen::Vector3d& direction) {
          return horizon.contains(direction) && apart_from_all(directions, direction);
        });
    if (!strongest || evidence(rest, *strongest) < kMinEvidence) break;
    add(directions, *strongest, Orientation::horizontal);
    refine_together(circles, directions);
  }
  return directions;
}

// Beyond 1 the line is not of the direction.
double relative_misfit(const GreatCircle& circle, const Eigen::Vector3d& direction,
                       VanishingMethod method) {
  return method == VanishingMethod::clustering
             ? circle.arc_distance_rad(direction) / kMaxArcDistanceRad
             : misfit_sigmas(circle, direction) / kMaxMisfitSigmas;
}

std::optional<std::size_t> class_of(const GreatCircle& circle, const Directions& directions,
                                    VanishingMethod method) {
  std::optional<std::size_t> nearest;
  double least = 1;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double misfit = relative_misfit(circle, directions[i].direction, method);
    if (misfit >= least) continue;
    least = misfit;
    nearest = i;
  }
  return nearest;
}

}  // namespace

VanishingDirections vanishing_directions(std::span<const LineSegment> segments, const Pinhole& view,
                                         const VanishingSettings& settings) {
  std::vector<GreatCircle> circles;
  for (const LineSegment& segment : segments) {
    circles.push_back(great_circle(view, segment, settings.noise));
  }
  VanishingDirections found;
  found.directions = settings.method == VanishingMethod::clustering
                         ? by_clustering(circles, settings)
                         : by_evidence(circles, settings);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto direction = class_of(circles[i], found.directions, settings.method);
    if (direction) ++found.directions[*direction].lines;
    found.lines.push_back({segments[i], direction});
  }
  return found;
}

VanishingDirections vanishing_directions(const cv::Mat& gray, const Pinhole& view,
                                         const VanishingSettings& settings) {
  return vanishing_directions(line_segments(gray, settings.min_length_px), view, settings);
}

}  // namespace milepost
