#include "mapper/aerial/regions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

constexpr int kNormalReach = 3;  // points of an outline to either side that determine its normal

Picture resampled(const Picture& picture, double metres_per_pixel) {
  const double factor = picture.grid.metres_per_pixel / metres_per_pixel;
  Picture coarse;
  coarse.grid = {picture.grid.west_m, picture.grid.north_m, metres_per_pixel};
  cv::resize(picture.bgr, coarse.bgr, {}, factor, factor, cv::INTER_AREA);
  cv::resize(picture.covered, coarse.covered, coarse.bgr.size(), 0, 0, cv::INTER_NEAREST);
  return coarse;
}

// Sums over the pixels of each label, for its mean and standard deviation.
struct Sums {
  int pixels = 0;
  Eigen::Vector3d lab = Eigen::Vector3d::Zero();
  double squared_lightness = 0;
  cv::Point first;          // of its pixels, row by row
  int left = 0, right = 0;  // columns
  int bottom = 0;           // row
};

std::vector<Sums> sums_by_label(const RegionMap& map) {
  std::vector<Sums> all(map.label_count);
  for (int y = 0; y < map.labels.rows; ++y) {
    for (int x = 0; x < map.labels.cols; ++x) {
      Sums& sums = all[map.labels.at<int>(y, x)];
      const auto& lab = map.lab.at<cv::Vec3f>(y, x);
      if (sums.pixels == 0) {
        sums.first = {x, y};
        sums.left = sums.right = x;
      }
      ++sums.pixels;
      sums.lab += Eigen::Vector3d(lab[0], lab[1], lab[2]);
      sums.squared_lightness += static_cast<double>(lab[0]) * lab[0];
      sums.left = std::min(sums.left, x);
      sums.right = std::max(sums.right, x);
      sums.bottom = y;
    }
  }
  return all;
}

// The longest contour of the pixels of a label, in pixels of the map.
std::vector<cv::Point> contour_of(const RegionMap& map, int label, const Sums& sums) {
  const cv::Rect box(cv::Point(sums.left, sums.first.y),
                     cv::Point(sums.right + 1, sums.bottom + 1));
  cv::Mat mask;
  cv::copyMakeBorder(map.labels(box) == label, mask, 1, 1, 1, 1, cv::BORDER_CONSTANT);
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8UC1));
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE,
                   box.tl() - cv::Point(1, 1));
  return *std::max_element(contours.begin(), contours.end(), [](const auto& a, const auto& b) {
    return cv::contourArea(a) < cv::contourArea(b);
  });
}

std::vector<OutlinePoint> outline_of(const std::vector<cv::Point>& contour) {
  const auto count = static_cast<int>(contour.size());
  const double sense = cv::contourArea(contour, true) < 0 ? -1 : 1;
  std::vector<OutlinePoint> outline;
  outline.reserve(contour.size());
  for (int i = 0; i < count; ++i) {
    const cv::Point way =
        contour[(i + kNormalReach) % count] - contour[((i - kNormalReach) % count + count) % count];
    if (way == cv::Point()) continue;
    outline.push_back({Eigen::Vector2d(contour[i].x, contour[i].y),
                       sense * Eigen::Vector2d(way.y, -way.x).normalized()});
  }
  return outline;
}

Region region_of(const RegionMap& map, int label, const Sums& sums) {
  const double pixel_m2 = map.grid.metres_per_pixel * map.grid.metres_per_pixel;
  const std::vector<cv::Point> contour = contour_of(map, label, sums);
  const cv::Size2f rectangle = cv::minAreaRect(contour).size;
  Region region;
  region.label = label;
  region.area_m2 = sums.pixels * pixel_m2;
  region.length_m = std::max({rectangle.width, rectangle.height, 1.0F}) * map.grid.metres_per_pixel;
  region.width_m = std::max(std::min(rectangle.width, rectangle.height) * map.grid.metres_per_pixel,
                            map.grid.metres_per_pixel);
  region.mean_lab = sums.lab / sums.pixels;
  region.texture = std::sqrt(std::max(
      0.0, sums.squared_lightness / sums.pixels - region.mean_lab[0] * region.mean_lab[0]));
  region.outline = outline_of(contour);
  return region;
}

// The fields that the maps of all scales share: grid, lab and kinds.
RegionMap without_regions(const Picture& picture, double shadow_threshold,
                          const ClutterSettings& clutter, const RegionSettings& settings) {
  Picture coarse = resampled(picture, settings.metres_per_pixel);
  // In floating point: integer grey values would have steps on a roof with a shading gradient.
  cv::Mat unit, smooth, grey;
  coarse.bgr.convertTo(unit, CV_32F, 1.0 / 255);
  cv::bilateralFilter(unit, smooth, 9, 30.0 / 255, 3);
  smooth.convertTo(coarse.bgr, CV_8U, 255);

  RegionMap map;
  map.grid = coarse.grid;
  cv::cvtColor(smooth, map.lab, cv::COLOR_BGR2Lab);
  cv::cvtColor(coarse.bgr, grey, cv::COLOR_BGR2GRAY);
  map.kinds = cv::Mat(grey.size(), CV_8UC1, cv::Scalar::all(kLit));
  map.kinds.setTo(kDark, grey < shadow_threshold);
  map.kinds.setTo(kGreen, green_mask(coarse, clutter));
  cv::medianBlur(map.kinds, map.kinds, 5);
  map.kinds.setTo(kDark, coarse.covered == 0);
  return map;
}

void add_regions(RegionMap& map, const RegionSettings& settings) {
  const std::vector<Sums> sums = sums_by_label(map);
  const double min_pixels =
      settings.min_area_m2 / (settings.metres_per_pixel * settings.metres_per_pixel);
  for (int label = 0; label < map.label_count; ++label) {
    if (sums[label].pixels < min_pixels) continue;
    if (map.kinds.at<std::uint8_t>(sums[label].first) != kLit) continue;
    map.regions.push_back(region_of(map, label, sums[label]));
  }
}

}  // namespace

std::vector<RegionMap> region_maps(const Picture& picture, double shadow_threshold,
                                   const ClutterSettings& clutter, const RegionSettings& settings) {
  const RegionMap shared = without_regions(picture, shadow_threshold, clutter, settings);
  std::vector<RegionMap> maps;
  for (const double scale : settings.scales) {
    Segmentation segmentation = segmented(shared.lab, shared.kinds, settings.metres_per_pixel,
                                          {scale, settings.min_segment_m2});
    RegionMap map = shared;
    map.labels = std::move(segmentation.labels);
    map.label_count = segmentation.count;
    add_regions(map, settings);
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace milepost
