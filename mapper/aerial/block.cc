#include "mapper/aerial/block.h"

#include <algorithm>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

constexpr double kMinStraightM = 2;  // of lines used to detect straight sides of regions

void take_away(std::vector<cv::Mat>& maps, const cv::Mat& mask) {
  for (cv::Mat& map : maps) map.setTo(0, mask);
}

WallLines on_ground(const std::vector<PixelLine>& found, const PixelGrid& grid) {
  WallLines lines;
  lines.reserve(found.size());
  for (const PixelLine& line : found) {
    if (line.begin_px == line.end_px) continue;
    lines.push_back({grid.ground_from_pixel(line.begin_px), grid.ground_from_pixel(line.end_px)});
  }
  return lines;
}

WallLines straight_lines(const std::vector<cv::Mat>& maps, const Gradient& gradient,
                         const PixelGrid& grid, const ExtractionSettings& settings) {
  if (settings.without.contains(Stage::progressive)) {
    return on_ground(plain_hough(maps[maps.size() / 2], grid.metres_per_pixel, settings.hough),
                     grid);
  }
  return on_ground(progressive_hough(maps, gradient, grid.metres_per_pixel, settings.hough), grid);
}

WallLines walls_of_roofs(const Picture& picture, const ImageLight& light, const WallLines& lines,
                         const ExtractionSettings& settings, const StagePictures& pictures) {
  WallLines straight;
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(straight),
               [](const WallLine& line) { return line.length_m() >= kMinStraightM; });
  const std::vector<RegionMap> maps =
      region_maps(picture, light.shadow_threshold, settings.clutter, settings.regions);
  std::vector<cv::Mat> by_scale;
  for (const RegionMap& map : maps) {
    const std::vector<double> probabilities =
        roof_probabilities(map, roof_features(map, straight, light.sun), settings.roofs);
    by_scale.push_back(roof_picture(map, probabilities, settings.roofs));
    pictures.show_regions("6-regions-" + std::to_string(by_scale.size()), map.labels);
  }
  const cv::Mat roofs = over_scales(by_scale);
  pictures.show_share("7-roofs", roofs);
  return at_roof_edges(lines, roofs, maps.front().grid, settings.roof_edges);
}

}  // namespace

WallLines block_walls(const Picture& picture, const ImageLight& light,
                      const ExtractionSettings& settings, const StagePictures& pictures) {
  const double metres_per_pixel = picture.grid.metres_per_pixel;
  cv::Mat grey;
  cv::cvtColor(picture.bgr, grey, cv::COLOR_BGR2GRAY);
  const Gradient gradient = gradient_of(picture, settings.edges);
  std::vector<cv::Mat> maps = edge_maps(picture, gradient, settings.edges);
  pictures.show("1-picture", picture.bgr);
  pictures.show_maps("2-edges", maps);
  if (!settings.without.contains(Stage::shadows)) {
    const cv::Mat shadows =
        shadow_mask(grey, light.shadow_threshold, metres_per_pixel, settings.shadows);
    const cv::Mat borders =
        far_borders(grey, shadows, light.sun, metres_per_pixel, settings.shadows);
    pictures.show_masks("3-shadows", picture.bgr, shadows, borders);
    take_away(maps, borders);
  }
  if (!settings.without.contains(Stage::vegetation)) {
    const cv::Mat rough = rough_mask(grey, metres_per_pixel, settings.clutter);
    const cv::Mat green = green_mask(picture, settings.clutter);
    pictures.show_masks("4-clutter", picture.bgr, green, rough);
    take_away(maps, rough);
    take_away(maps, within(green, metres_per_pixel, settings.clutter));
  }
  WallLines lines = straight_lines(maps, gradient, picture.grid, settings);
  pictures.show_lines("5-lines", picture, lines);
  if (!settings.without.contains(Stage::roofs)) {
    lines = walls_of_roofs(picture, light, lines, settings, pictures);
    pictures.show_lines("8-roof-edges", picture, lines);
  }
  return lines;
}

}  // namespace milepost
