#include "tests/mapper/aerial/drawn_yard.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <opencv2/imgproc.hpp>

namespace milepost::testing {
namespace {

const cv::Scalar kGround(110, 150, 180);  // blue, green, red
const cv::Scalar kRoof(60, 80, 190);
const cv::Scalar kTree(50, 120, 60);
constexpr double kShade = 0.3;  // of the light, in a shadow

const GroundFrame& yard_frame() {
  static const GroundFrame frame({0.35, 32.59, 0});
  return frame;
}

std::vector<Eigen::Vector2d> corners_of(const House& house) {
  const double turn_rad = house.turn_deg * kRadPerDeg;
  const Eigen::Vector2d along(std::cos(turn_rad), std::sin(turn_rad));
  const Eigen::Vector2d left(-along.y(), along.x());
  const Eigen::Vector2d half_length = along * house.length_m / 2;
  const Eigen::Vector2d half_width = left * house.width_m / 2;
  return {house.middle_m - half_length - half_width, house.middle_m - half_length + half_width,
          house.middle_m + half_length + half_width, house.middle_m + half_length - half_width};
}

std::vector<cv::Point> pixels_of(const House& house, const PixelGrid& grid,
                                 const Eigen::Vector2d& shift_m) {
  std::vector<cv::Point> pixels;
  for (const Eigen::Vector2d& corner : corners_of(house)) {
    const Eigen::Vector2d at = grid.pixel_from_ground(corner + shift_m);
    pixels.emplace_back(static_cast<int>(std::lround(at.x())),
                        static_cast<int>(std::lround(at.y())));
  }
  return pixels;
}

void darken(cv::Mat& bgr, const cv::Mat& mask) {
  cv::Mat dark;
  bgr.convertTo(dark, -1, kShade);
  dark.copyTo(bgr, mask);
}

}  // namespace

WallLines walls_of(const House& house) {
  const std::vector<Eigen::Vector2d> corners = corners_of(house);
  WallLines walls;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    walls.push_back({corners[i], corners[(i + 1) % corners.size()]});
  }
  return walls;
}

Picture drawn(const Yard& yard, double metres_per_pixel) {
  Picture picture;
  picture.grid = {0, yard.size_m.y(), metres_per_pixel};
  const cv::Size size(static_cast<int>(yard.size_m.x() / metres_per_pixel),
                      static_cast<int>(yard.size_m.y() / metres_per_pixel));
  picture.bgr = cv::Mat(size, CV_8UC3, kGround);
  picture.covered = cv::Mat(size, CV_8UC1, cv::Scalar::all(255));
  cv::Mat shadows = cv::Mat::zeros(size, CV_8UC1);
  for (const House& house : yard.houses) {
    for (double reach_m = 0; reach_m < yard.shadow_m; reach_m += metres_per_pixel) {
      const auto outline = pixels_of(house, picture.grid, reach_m * shadow_direction(yard.sun));
      cv::fillConvexPoly(shadows, outline, cv::Scalar::all(255));
    }
  }
  darken(picture.bgr, shadows);
  for (const House& house : yard.houses) {
    cv::fillConvexPoly(picture.bgr, pixels_of(house, picture.grid, Eigen::Vector2d::Zero()), kRoof);
  }
  cv::RNG random(7);
  cv::Mat noise(size, CV_16SC3);
  cv::Mat rough(size, CV_16SC1);
  random.fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0), cv::Scalar::all(3));
  random.fill(rough, cv::RNG::NORMAL, cv::Scalar::all(0), cv::Scalar::all(60));
  cv::GaussianBlur(rough, rough, {}, 0.15 / metres_per_pixel);
  cv::merge(std::vector<cv::Mat>(3, 6 * rough), rough);
  cv::add(picture.bgr, noise, picture.bgr, cv::noArray(), CV_8U);
  for (const Eigen::Vector2d& tree : yard.trees) {
    const Eigen::Vector2d at = picture.grid.pixel_from_ground(tree);
    cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
    cv::circle(mask, {static_cast<int>(at.x()), static_cast<int>(at.y())},
               static_cast<int>(3 / metres_per_pixel), cv::Scalar::all(255), cv::FILLED);
    picture.bgr.setTo(kTree, mask);
    cv::add(picture.bgr, rough, picture.bgr, mask, CV_8U);
  }
  return picture;
}

void write_geotiff(const Picture& picture, const std::filesystem::path& file) {
  GDALAllRegister();
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(file.c_str(), picture.bgr.cols, picture.bgr.rows, 3, GDT_Byte, nullptr));
  ASSERT_NE(dataset, nullptr);
  double transform[6] = {
      picture.grid.west_m,           picture.grid.metres_per_pixel, 0, picture.grid.north_m, 0,
      -picture.grid.metres_per_pixel};
  OGRSpatialReference reference;
  ASSERT_EQ(reference.importFromProj4(yard_frame().proj().c_str()), OGRERR_NONE);
  ASSERT_EQ(dataset->SetGeoTransform(transform), CE_None);
  ASSERT_EQ(dataset->SetSpatialRef(&reference), CE_None);
  for (int channel = 0; channel < 3; ++channel) {
    cv::Mat plane;
    cv::extractChannel(picture.bgr, plane, 2 - channel);
    ASSERT_EQ(dataset->GetRasterBand(channel + 1)
                  ->RasterIO(GF_Write, 0, 0, plane.cols, plane.rows, plane.data, plane.cols,
                             plane.rows, GDT_Byte, 0, 0),
              CE_None);
  }
}

GeoPoint geo_from_yard(const Eigen::Vector2d& yard_m) {
  return yard_frame().geo_from_ground(yard_m);
}

bool is_found(const WallLine& wall, const WallLines& lines, double reach_m) {
  const double length_m = wall.length_m();
  for (double along_m = 0.5; along_m <= length_m - 0.5; along_m += 0.25) {
    const Eigen::Vector2d at_m = wall.begin_m + along_m * direction_of(wall);
    const bool found = std::any_of(lines.begin(), lines.end(), [&](const WallLine& line) {
      const Eigen::Vector2d along = direction_of(line);
      const double on_line_m = along.dot(at_m - line.begin_m);
      return std::abs(along.dot(direction_of(wall))) > 0.97 && on_line_m >= -reach_m &&
             on_line_m <= line.length_m() + reach_m &&
             std::abs(right_of(along).dot(at_m - line.begin_m)) <= reach_m;
    });
    if (!found) return false;
  }
  return true;
}

}  // namespace milepost::testing
