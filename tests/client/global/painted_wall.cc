#include "tests/client/global/painted_wall.h"

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace milepost::testing {
namespace {

constexpr double kPixelPerM = 60;  // of the wall's image

}  // namespace

cv::Mat painted_wall() {
  cv::Mat wall(static_cast<int>(40 * kPixelPerM), static_cast<int>(60 * kPixelPerM), CV_8UC1,
               cv::Scalar(128));
  cv::RNG random(4);
  for (int i = 0; i < 9000; ++i) {
    const cv::Point at(random.uniform(0, wall.cols), random.uniform(0, wall.rows));
    const int size = random.uniform(4, 40);
    cv::rectangle(wall, {at.x, at.y, size, random.uniform(4, 40)}, random.uniform(0, 255),
                  cv::FILLED);
  }
  cv::GaussianBlur(wall, wall, {0, 0}, 1.5);
  return wall;
}

cv::Mat seen(const cv::Mat& wall, double ahead_m, double turn_rad, double pitch_rad) {
  const Eigen::Matrix3d camera_from_first =
      Eigen::AngleAxisd(-pitch_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
      Eigen::AngleAxisd(-turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  // A point (x, y) of the wall's image lies at ((x, y) - middle) / kPixelPerM, kWallM ahead.
  Eigen::Matrix3d first_from_picture;
  first_from_picture << 1 / kPixelPerM, 0, -30, 0, 1 / kPixelPerM, -20, 0, 0, kWallM - ahead_m;
  Eigen::Matrix3d pixel_from_camera;
  pixel_from_camera << kView.focal_x_px, 0, kView.principal_x_px, 0, kView.focal_y_px,
      kView.principal_y_px, 0, 0, 1;
  const Eigen::Matrix3d h = pixel_from_camera * camera_from_first * first_from_picture;
  cv::Mat homography(3, 3, CV_64F);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) homography.at<double>(r, c) = h(r, c);
  }
  cv::Mat image;
  cv::warpPerspective(wall, image, homography, {600, 500}, cv::INTER_AREA);
  return image;
}

}  // namespace milepost::testing
