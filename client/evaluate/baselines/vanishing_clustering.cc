#include "client/evaluate/baselines/vanishing_clustering.h"

#include <algorithm>

#include "client/evaluate/baselines/subtractive_clustering.h"
#include "client/global/direction_search.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// With more lines the pairs make clustering slow and hardly better.
constexpr std::size_t kClusteredLines = 90;
constexpr double kMinMeetingAngleRad = 0.5 * kRadPerDeg;
constexpr double kMaxArcDistanceRad = 4 * kRadPerDeg;

std::vector<VanishingDirection> directions_of(std::span<const GreatCircle> circles,
                                              const VanishingSettings& settings) {
  const Zone pole = vertical_zone(settings);
  const Zone equator = horizontal_zone(settings);
  std::vector<Eigen::Vector3d> polar;
  std::vector<Eigen::Vector3d> equatorial;
  const auto longest = circles.first(std::min(kClusteredLines, circles.size()));
  for (const Eigen::Vector3d& point : intersections(longest, kMinMeetingAngleRad)) {
    if (pole.contains(point)) polar.push_back(point);
    if (equator.contains(point)) equatorial.push_back(point);
  }
  std::vector<VanishingDirection> directions;
  ClusteringSettings clustering;
  clustering.max_centres = 1;
  for (const auto& centre : cluster_centres(polar, clustering)) {
    directions.push_back(vanishing_direction(centre, Orientation::vertical));
  }
  clustering.max_centres = settings.max_horizontal;
  for (const auto& centre : cluster_centres(equatorial, clustering)) {
    directions.push_back(vanishing_direction(centre, Orientation::horizontal));
  }
  return directions;
}

}  // namespace

VanishingDirections clustered_vanishing_directions(std::span<const LineSegment> segments,
                                                   const Pinhole& view,
                                                   const VanishingSettings& settings) {
  const std::vector<GreatCircle> circles = great_circles(view, segments, settings.noise);
  return with_lines(segments, circles, directions_of(circles, settings),
                    [](const GreatCircle& circle, const Eigen::Vector3d& direction) {
                      return circle.arc_distance_rad(direction) / kMaxArcDistanceRad;
                    });
}

VanishingDirections clustered_vanishing_directions(const cv::Mat& gray, const Camera& camera,
                                                   const VanishingSettings& settings) {
  return clustered_vanishing_directions(
      undistorted(line_segments(gray, settings.min_length_px), camera), camera.pinhole, settings);
}

}  // namespace milepost
