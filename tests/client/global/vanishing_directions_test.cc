#include "client/global/vanishing_directions.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "tests/client/global/edge_scene.h"

namespace milepost {
namespace {

using testing::kEdgeCamera;
using testing::kEdgeView;
using testing::level_direction;
using testing::nearest_deg;
using testing::project;
using testing::turn;
using Scene = testing::EdgeScene;

TEST(VanishingDirections, BoxesSeenByATurnedCameraGiveTheirDirections) {
  for (const double roll_deg : {-15.0, 0.0, 10.0}) {
    for (const double tilt_deg : {-12.0, 0.0, 20.0}) {
      const Eigen::Matrix3d turned =
          turn(roll_deg, Eigen::Vector3d::UnitZ()) * turn(tilt_deg, Eigen::Vector3d::UnitX());
      // The third wall is perpendicular to neither of the others.
      const Scene scene({{0, 1, 0}, level_direction(35), level_direction(-55), level_direction(80)},
                        turned, 0.3, 25, 40);
      const VanishingDirections found = vanishing_directions(scene.segments, kEdgeView);
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
  testing::expect_lines_classed(scene, vanishing_directions(scene.segments, kEdgeView));
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
            256 * project(corner + side_m * along + Eigen::Vector3d(0, height_m, 0));
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

// The image from the camera after a rotation about its centre.
cv::Mat seen_turned(const cv::Mat& image, const Eigen::Matrix3d& turned) {
  Eigen::Matrix3d pixels;
  pixels << kEdgeView.focal_x_px, 0, kEdgeView.principal_x_px, 0, kEdgeView.focal_y_px,
      kEdgeView.principal_y_px, 0, 0, 1;
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
    const VanishingDirections found = vanishing_directions(seen_turned(image, turned), kEdgeCamera);
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

// The image through a lens.
cv::Mat seen_through(const cv::Mat& image, const Camera& camera) {
  cv::Mat places(image.size(), CV_32FC2, cv::Scalar::all(-1));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto at = camera.pinhole_from_image({x, y});
      if (at)
        places.at<cv::Vec2f>(y, x) = {static_cast<float>(at->pinhole_px.x()),
                                      static_cast<float>(at->pinhole_px.y())};
    }
  }
  cv::Mat seen;
  cv::remap(image, seen, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
            cv::Scalar(230));
  return seen;
}

TEST(VanishingDirections, ALensThatBendsEdgesTurnsNoDirection) {
  Camera camera = kEdgeCamera;
  camera.lens = *Lens::make(LensModel::brown_conrady, {-0.35, 0.1});
  const cv::Mat bent = seen_through(drawn_corner(), camera);
  const auto worst_deg = [](const VanishingDirections& found) {
    return std::max({nearest_deg(found, Eigen::Vector3d::UnitY(), Orientation::vertical),
                     nearest_deg(found, level_direction(50), Orientation::horizontal),
                     nearest_deg(found, level_direction(-40), Orientation::horizontal)});
  };
  EXPECT_LT(worst_deg(vanishing_directions(bent, camera)), 0.5);
  EXPECT_GT(worst_deg(vanishing_directions(bent, kEdgeCamera)), 1);  // were it not told
}

TEST(VanishingDirections, AnImageWithoutLinesHasNone) {
  const VanishingDirections found =
      vanishing_directions(cv::Mat(480, 640, CV_8UC1, cv::Scalar(128)), kEdgeCamera);
  EXPECT_TRUE(found.directions.empty());
  EXPECT_TRUE(found.lines.empty());
}

TEST(VanishingDirections, LinesEverywhichWayHaveNone) {
  const Scene scene({}, Eigen::Matrix3d::Identity(), 0, 0, 30);
  const VanishingDirections found = vanishing_directions(scene.segments, kEdgeView);
  EXPECT_TRUE(found.directions.empty());
  EXPECT_EQ(found.lines.size(), 30u);
}

}  // namespace
}  // namespace milepost
