#include "client/global/vanishing_directions.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

const Pinhole kView{600, 600, 320, 240};

Eigen::Matrix3d turn(double deg, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(deg * kRadPerDeg, axis).toRotationMatrix();
}

Eigen::Vector2d pixel_of(const Eigen::Vector3d& point) {
  return {kView.principal_x_px + kView.focal_x_px * point.x() / point.z(),
          kView.principal_y_px + kView.focal_y_px * point.y() / point.z()};
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b)))) / kRadPerDeg;
}

double nearest_deg(const VanishingDirections& found, const Eigen::Vector3d& direction,
                   Orientation orientation) {
  double nearest = 90;
  for (const VanishingDirection& other : found.directions) {
    if (other.orientation == orientation) {
      nearest = std::min(nearest, angle_deg(other.direction, direction));
    }
  }
  return nearest;
}

// Edges of boxes before a camera, in the frame of a level camera (x right, y down, z forward), in
// the directions given, seen by a camera that is turned; with noise and outliers.
struct Scene {
  std::vector<Eigen::Vector3d> directions;
  Eigen::Matrix3d camera_from_level;
  std::vector<LineSegment> segments;  // the longest first
  std::vector<int> classes;           // index into directions, -1 for an outlier

  Scene(std::vector<Eigen::Vector3d> edges, Eigen::Matrix3d turned, double noise_px, int lines_each,
        int outliers)
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
            {{moved(pixel_of(camera_from_level * from)), moved(pixel_of(camera_from_level * to))},
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

Eigen::Vector3d level_direction(double azimuth_deg) {
  return {std::sin(azimuth_deg * kRadPerDeg), 0, std::cos(azimuth_deg * kRadPerDeg)};
}

TEST(VanishingDirections, BoxesSeenByATurnedCameraGiveTheirDirections) {
  for (const double roll_deg : {-15.0, 0.0, 10.0}) {
    for (const double tilt_deg : {-12.0, 0.0, 20.0}) {
      const Eigen::Matrix3d turned =
          turn(roll_deg, Eigen::Vector3d::UnitZ()) * turn(tilt_deg, Eigen::Vector3d::UnitX());
      // The third wall is square to neither of the others.
      const Scene scene({{0, 1, 0}, level_direction(35), level_direction(-55), level_direction(80)},
                        turned, 0.3, 25, 40);
      const VanishingDirections found = vanishing_directions(scene.segments, kView);
      EXPECT_EQ(found.directions.size(), 4u);
      for (std::size_t d = 0; d < scene.directions.size(); ++d) {
        EXPECT_LT(nearest_deg(found, turned * scene.directions[d],
                              d == 0 ? Orientation::vertical : Orientation::horizontal),
                  1.0)
            << "direction " << d << ", roll " << roll_deg << ", tilt " << tilt_deg;
      }
    }
  }
}

TEST(VanishingDirections, LinesAreClassedAndOutliersLeftOut) {
  const Scene scene({{0, 1, 0}, level_direction(35), level_direction(-55)},
                    turn(5, Eigen::Vector3d::UnitX()), 0.3, 30, 40);
  for (const VanishingMethod method : {VanishingMethod::evidence, VanishingMethod::clustering}) {
    VanishingSettings settings;
    settings.method = method;
    const VanishingDirections found = vanishing_directions(scene.segments, kView, settings);
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
    EXPECT_GT(outliers_left_out, 20);  // of 40: the others point at a direction by chance
    for (std::size_t d = 0; d < lines.size(); ++d) EXPECT_EQ(found.directions[d].lines, lines[d]);
  }
}

TEST(VanishingDirections, ClusteringFindsThemRoughly) {
  const Scene scene({{0, 1, 0}, level_direction(35), level_direction(-55)},
                    turn(5, Eigen::Vector3d::UnitX()), 0.3, 30, 20);
  VanishingSettings settings;
  settings.method = VanishingMethod::clustering;
  const VanishingDirections found = vanishing_directions(scene.segments, kView, settings);
  for (std::size_t d = 0; d < 3; ++d) {
    EXPECT_LT(nearest_deg(found, scene.camera_from_level * scene.directions[d],
                          d == 0 ? Orientation::vertical : Orientation::horizontal),
              4.0)
        << d;
  }
}

// Two walls of a house corner with rows of windows, drawn from a level camera.
cv::Mat drawn_corner() {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(230));
  const Eigen::Vector3d corner(0.3, 0, 8);
  for (const double azimuth_deg : {50.0, -40.0}) {
    const Eigen::Vector3d along = level_direction(azimuth_deg);
    const auto fill = [&](double from_m, double to_m, double top_m, double bottom_m, int grey) {
      std::vector<cv::Point> outline;
      for (const auto& [side_m, height_m] :
           {std::pair{from_m, top_m}, std::pair{to_m, top_m}, std::pair{to_m, bottom_m},
            std::pair{from_m, bottom_m}}) {
        const Eigen::Vector2d pixel =
            256 * pixel_of(corner + side_m * along + Eigen::Vector3d(0, height_m, 0));
        outline.emplace_back(static_cast<int>(std::lround(pixel.x())),
                             static_cast<int>(std::lround(pixel.y())));
      }
      cv::fillConvexPoly(image, outline, cv::Scalar(grey), cv::LINE_AA, 8);
    };
    fill(0, 5, -2.2, 2.2, azimuth_deg > 0 ? 150 : 110);
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 3; ++row) {
        const double left_m = 0.4 + 1.1 * column;
        const double top_m = -1.9 + 1.4 * row;
        fill(left_m, left_m + 0.7, top_m, top_m + 0.9, 30);
      }
    }
  }
  return image;
}

// The image that the camera takes after it has been turned about its centre.
cv::Mat seen_turned(const cv::Mat& image, const Eigen::Matrix3d& turned) {
  Eigen::Matrix3d pixels;
  pixels << kView.focal_x_px, 0, kView.principal_x_px, 0, kView.focal_y_px, kView.principal_y_px, 0,
      0, 1;
  const Eigen::Matrix3d homography = pixels * turned * pixels.inverse();
  cv::Mat matrix(3, 3, CV_64F);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      matrix.at<double>(row, column) = homography(row, column);
    }
  }
  cv::Mat seen;
  cv::warpPerspective(image, seen, matrix, image.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
                      cv::Scalar(230));
  return seen;
}

TEST(VanishingDirections, TurningTheImageTurnsTheDirections) {
  const cv::Mat image = drawn_corner();
  for (const Eigen::Matrix3d& turned :
       {turn(0, Eigen::Vector3d::UnitZ()), turn(10, Eigen::Vector3d::UnitZ()),
        turn(-10, Eigen::Vector3d::UnitZ()), turn(8, Eigen::Vector3d::UnitX()),
        turn(-8, Eigen::Vector3d::UnitX())}) {
    const VanishingDirections found = vanishing_directions(seen_turned(image, turned), kView);
    EXPECT_LT(nearest_deg(found, turned * Eigen::Vector3d::UnitY(), Orientation::vertical), 0.5)
        << turned;
    for (const double azimuth_deg : {50.0, -40.0}) {
      EXPECT_LT(nearest_deg(found, turned * level_direction(azimuth_deg), Orientation::horizontal),
                0.5)
          << azimuth_deg << "\n"
          << turned;
    }
    for (const VanishingDirection& direction : found.directions) {
      EXPECT_NEAR(direction.direction.norm(), 1, 1e-9);
      const bool is_vertical = direction.orientation == Orientation::vertical;
      EXPECT_TRUE(is_vertical ? direction.direction.y() < 0 : direction.direction.z() >= 0);
    }
  }
}

TEST(VanishingDirections, AnImageWithoutLinesHasNone) {
  const VanishingDirections found =
      vanishing_directions(cv::Mat(480, 640, CV_8UC1, cv::Scalar(128)), kView);
  EXPECT_TRUE(found.directions.empty());
  EXPECT_TRUE(found.lines.empty());
}

TEST(VanishingDirections, LinesEverywhichWayHaveNone) {
  const Scene scene({}, Eigen::Matrix3d::Identity(), 0, 0, 30);
  const VanishingDirections found = vanishing_directions(scene.segments, kView);
  EXPECT_TRUE(found.directions.empty());
  EXPECT_EQ(found.lines.size(), 30u);
}

}  // namespace
}  // namespace milepost
