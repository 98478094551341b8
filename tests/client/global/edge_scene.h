// Edges of boxes in front of a camera, and the fit of detected directions to them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "client/global/vanishing_directions.h"
#include "schema/geo/geodesy.h"

namespace milepost::testing {

inline constexpr Pinhole kEdgeView{600, 600, 320, 240};
inline const Camera kEdgeCamera{640, 480, kEdgeView};

inline Eigen::Matrix3d turn(double deg, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(deg * kRadPerDeg, axis).toRotationMatrix();
}

inline Eigen::Vector2d project(const Eigen::Vector3d& point) { return kEdgeView.project(point); }

inline double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b)))) / kRadPerDeg;
}

inline double nearest_deg(const VanishingDirections& found, const Eigen::Vector3d& direction,
                          Orientation orientation) {
  double nearest = 90;
  for (const VanishingDirection& other : found.directions) {
    if (other.orientation == orientation) {
      nearest = std::min(nearest, angle_deg(other.direction, direction));
    }
  }
  return nearest;
}

// Edges of boxes in front of a camera, in given directions in the frame of a level camera (x right,
// y down, z forward), observed by a rotated camera, with noise and outliers.
struct EdgeScene {
  std::vector<Eigen::Vector3d> directions;
  Eigen::Matrix3d camera_from_level;
  std::vector<LineSegment> segments;  // the longest first
  std::vector<int> classes;           // index into directions, -1 for an outlier

  EdgeScene(std::vector<Eigen::Vector3d> edges, Eigen::Matrix3d turned, double noise_px,
            int lines_each, int outliers)
      : directions(std::move(edges)), camera_from_level(std::move(turned)) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, noise_px);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<std::pair<LineSegment, int>> drawn;
    const auto moved = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
      return pixel + Eigen::Vector2d(noise(random), noise(random));
    };
    for (std::size_t d = 0; d < directions.size(); ++d) {
      for (int i = 0; i < lines_each; ++i) {
        const Eigen::Vector3d from(6 * unit(random), 4 * unit(random), 14 + 4 * unit(random));
        const Eigen::Vector3d to = from + (2 + unit(random)) * directions[d];
        drawn.push_back(
            {{moved(project(camera_from_level * from)), moved(project(camera_from_level * to))},
             static_cast<int>(d)});
      }
    }
    for (int i = 0; i < outliers; ++i) {
      const Eigen::Vector2d from(320 + 300 * unit(random), 240 + 220 * unit(random));
      drawn.push_back({{from, from + 60 * Eigen::Vector2d(unit(random), unit(random))}, -1});
    }
    std::stable_sort(drawn.begin(), drawn.end(), [](const auto& a, const auto& b) {
      return a.first.length_px() > b.first.length_px();
    });
    for (const auto& [segment, index] : drawn) {
      segments.push_back(segment);
      classes.push_back(index);
    }
  }
};

inline Eigen::Vector3d level_direction(double azimuth_deg) {
  return {std::sin(azimuth_deg * kRadPerDeg), 0, std::cos(azimuth_deg * kRadPerDeg)};
}

// Of a scene with three directions, 30 lines each, and 40 outliers.
inline void expect_lines_classed(const EdgeScene& scene, const VanishingDirections& found) {
  ASSERT_EQ(found.lines.size(), scene.segments.size());
  std::vector<std::size_t> lines(found.directions.size());
  int right = 0;
  int outliers_left_out = 0;
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    const auto& direction = found.lines[i].direction;
    if (direction) ++lines[*direction];
    if (scene.classes[i] < 0) {
      outliers_left_out += direction ? 0 : 1;
    } else if (direction) {
      const Eigen::Vector3d truth =
          scene.camera_from_level * scene.directions[static_cast<std::size_t>(scene.classes[i])];
      right += angle_deg(found.directions[*direction].direction, truth) < 5 ? 1 : 0;
    }
  }
  EXPECT_GT(right, 80);              // of 90
  EXPECT_GT(outliers_left_out, 20);  // of 40: the others fit a direction by chance
  for (std::size_t d = 0; d < lines.size(); ++d) EXPECT_EQ(found.directions[d].lines, lines[d]);
}

}  // namespace milepost::testing
