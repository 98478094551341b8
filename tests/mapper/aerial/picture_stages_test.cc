// The stages with a picture as input: edges, shadows, clutter, lines, regions, roofs, the sun.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "mapper/aerial/block.h"
#include "mapper/aerial/clutter.h"
#include "mapper/aerial/edge_maps.h"
#include "mapper/aerial/progressive_hough.h"
#include "mapper/aerial/regions.h"
#include "mapper/aerial/roofs.h"
#include "mapper/aerial/segmentation.h"
#include "mapper/aerial/shadows.h"
#include "mapper/aerial/stage_pictures.h"
#include "mapper/aerial/sun_evidence.h"
#include "tests/mapper/aerial/drawn_yard.h"

namespace milepost {
namespace {

using testing::drawn;
using testing::House;
using testing::is_found;
using testing::walls_of;
using testing::Yard;

constexpr double kPixelM = 0.1;
constexpr double kShadowThreshold = 85;  // the drawn ground has 154, in shadow 46; roofs have 111

const House kHouse{{20, 15}, 12, 8, 20};

Yard one_house() { return {{40, 30}, {kHouse}, {300, 45}, 3, {}}; }

cv::Mat grey_of(const Picture& picture) {
  cv::Mat grey;
  cv::cvtColor(picture.bgr, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

// The share of a wall's points that a mask has, `beside_m` to its left, outside of the house.
double share_beside(const cv::Mat& mask, const PixelGrid& grid, const WallLine& wall,
                    double beside_m) {
  int hits = 0;
  int points = 0;
  for (double along_m = 1; along_m < wall.length_m() - 1; along_m += kPixelM, ++points) {
    const Eigen::Vector2d at = grid.pixel_from_ground(wall.begin_m + along_m * direction_of(wall) -
                                                      beside_m * right_of(direction_of(wall)));
    hits += mask.at<std::uint8_t>(static_cast<int>(std::lround(at.y())),
                                  static_cast<int>(std::lround(at.x()))) != 0;
  }
  return static_cast<double>(hits) / points;
}

// Whether the wall's shadow falls on the ground in front of it.
bool casts_shadow(const WallLine& wall, const Sun& sun) {
  return -right_of(direction_of(wall)).dot(shadow_direction(sun)) > 0.3;
}

// A roof of 12 x 8 m with a shading gradient of 12 grey values from end to end, without noise.
Picture flat_roof_in_grass() {
  Picture picture = drawn({{24, 20}, {}, {}, 0, {}});
  picture.bgr.setTo(cv::Scalar(50, 120, 60));
  for (int x = 60; x < 180; ++x) {
    picture.bgr(cv::Rect(x, 60, 1, 80)).setTo(cv::Scalar::all(140 + (x - 60) / 10.0));
  }
  return picture;
}

// At one scale.
RegionMap regions_of(const Picture& picture, double min_segment_m2 = 2) {
  RegionSettings settings;
  settings.scales = {60};
  settings.min_segment_m2 = min_segment_m2;
  return region_maps(picture, kShadowThreshold, {}, settings).front();
}

WallLines lines_of(const Picture& picture, const std::vector<cv::Mat>& maps,
                   const HoughSettings& settings = {}) {
  WallLines lines;
  const Gradient gradient = gradient_of(picture, {});
  for (const PixelLine& found : progressive_hough(maps, gradient, kPixelM, settings)) {
    lines.push_back({picture.grid.ground_from_pixel(found.begin_px),
                     picture.grid.ground_from_pixel(found.end_px)});
  }
  return lines;
}

TEST(EdgeMaps, LooserMapsHoldStricterOnes) {
  Yard yard = one_house();
  yard.trees = {{33, 24}};
  const Picture picture = drawn(yard);
  const std::vector<cv::Mat> maps = edge_maps(picture, gradient_of(picture, {}), {});
  ASSERT_EQ(maps.size(), 3U);
  EXPECT_GT(cv::countNonZero(maps[0]), 0);
  for (std::size_t i = 1; i < maps.size(); ++i) {
    EXPECT_EQ(cv::countNonZero(maps[i - 1] & ~maps[i]), 0);
  }
}

// A step to the right of a column, by these grey values of blue, green and red.
Picture step_of(const cv::Scalar& step) {
  Picture picture = drawn({{20, 20}, {}, {}, 0, {}});
  picture.bgr.setTo(cv::Scalar::all(60));
  picture.bgr.colRange(100, 200).setTo(cv::Scalar::all(60) + step);
  return picture;
}

Picture turned(const Picture& picture) {
  Picture quarter = picture;
  cv::transpose(picture.bgr, quarter.bgr);
  return quarter;
}

TEST(EdgeMaps, TheStrongestChannelTellsTheGradient) {
  const Gradient grey = gradient_of(step_of(cv::Scalar::all(100)), {});
  double most = 0;
  cv::minMaxLoc(grey.x, nullptr, &most);
  EXPECT_GT(most, 100);
  for (const cv::Scalar& step :
       {cv::Scalar(100, 0, 30), cv::Scalar(0, 100, 30), cv::Scalar(30, 10, 100)}) {
    const Gradient found = gradient_of(step_of(step), {});
    EXPECT_EQ(cv::norm(found.x, grey.x, cv::NORM_INF), 0) << step;
    EXPECT_EQ(cv::countNonZero(found.y), 0) << step;
    const Gradient across = gradient_of(turned(step_of(step)), {});
    EXPECT_EQ(cv::norm(across.y, grey.x.t(), cv::NORM_INF), 0) << step;
    EXPECT_EQ(cv::countNonZero(across.x), 0) << step;
  }
}

TEST(EdgeMaps, AnEdgeReachesThePicturesBorder) {
  const Picture picture = step_of(cv::Scalar::all(100));
  const cv::Mat edges = edge_maps(picture, gradient_of(picture, {}), {}).front();
  for (const int row : {1, 198}) EXPECT_GT(cv::countNonZero(edges.row(row)), 0) << row;
}

// Thresholds in grey values per metre; a fading edge continues down to a share of that.
TEST(EdgeMaps, AnEdgeBeginsWhereItIsStrongAndGoesOnWhereItFades) {
  Picture picture = step_of(cv::Scalar::all(0));
  for (int y = 0; y < 200; ++y) {
    picture.bgr.row(y).colRange(100, 200).setTo(cv::Scalar::all(60 + y / 2.0));
  }
  EdgeSettings settings;
  const Gradient gradient = gradient_of(picture, settings);
  settings.high_per_m = {120};
  const auto first_row = [&] {
    const cv::Mat edges = edge_maps(picture, gradient, settings).front().colRange(95, 105);
    int row = 0;
    while (row < 200 && cv::countNonZero(edges.row(row)) == 0) ++row;
    return row;
  };
  const int begins = first_row();
  // Across a step that is smoothed by 1.5 pixels the gradient is 0.27 of it.
  EXPECT_NEAR(begins, 0.4 * 2 * 120 * kPixelM / 0.25, 8);
  settings.low_share = 1;
  EXPECT_NEAR(first_row(), 2 * 120 * kPixelM / 0.25, 8);
}

TEST(EdgeMaps, WhereDataEndsIsNoEdge) {
  Picture picture = drawn({{40, 30}, {}, {}, 0, {}});
  picture.covered.colRange(0, 150).setTo(0);
  picture.bgr.colRange(0, 150).setTo(0);
  const std::vector<cv::Mat> maps = edge_maps(picture, gradient_of(picture, {}), {});
  EXPECT_EQ(cv::countNonZero(maps.back()), 0);
}

TEST(Shadows, TheThresholdPartsShadowFromGround) {
  std::array<double, 256> histogram{};
  histogram[40] = 1000;
  histogram[120] = 5000;
  histogram[170] = 4000;
  const double threshold = shadow_threshold(histogram, {});
  EXPECT_GT(threshold, 40);
  EXPECT_LT(threshold, 100);
  EXPECT_EQ(shadow_threshold(std::array<double, 256>{}, {}), 0);
}

// Otsu's threshold weights both classes by size: a few dark pixels are not a shadow.
TEST(Shadows, AFewDarkPixelsAreNoShadow) {
  std::array<double, 256> histogram{};
  histogram[40] = 10;
  histogram[120] = 9000;
  histogram[200] = 900;
  ShadowSettings settings;
  settings.dark_share = 1;
  const double threshold = shadow_threshold(histogram, settings);
  EXPECT_GT(threshold, 120);
  EXPECT_LE(threshold, 200);
}

TEST(Shadows, TheFarBorderIsTakenAndTheWallIsKept) {
  for (const double azimuth_deg : {20.0, 120.0, 300.0}) {
    Yard yard = one_house();
    yard.sun.azimuth_deg = azimuth_deg;
    const Picture picture = drawn(yard);
    const cv::Mat grey = grey_of(picture);
    const cv::Mat shadows = shadow_mask(grey, kShadowThreshold, kPixelM, {});
    ShadowSettings settings;
    settings.max_angle_deg = 75;
    const cv::Mat borders = far_borders(grey, shadows, yard.sun, kPixelM, settings);
    for (const WallLine& wall : walls_of(kHouse)) {
      if (!casts_shadow(wall, yard.sun)) continue;
      const double depth_m = -3 * right_of(direction_of(wall)).dot(shadow_direction(yard.sun));
      EXPECT_GT(share_beside(shadows, picture.grid, wall, depth_m / 2), 0.6) << azimuth_deg;
      EXPECT_LT(share_beside(borders, picture.grid, wall, 0), 0.05) << azimuth_deg;
    }
    EXPECT_GT(cv::countNonZero(borders), 300) << azimuth_deg;
  }
}

// A shadow's sides are parallel to the light; other bright borders are not borders of a shadow.
TEST(Shadows, OnlyTheFarSideIsAFarBorder) {
  const Yard yard{{40, 30}, {House{{20, 15}, 12, 8, 0}}, {0, 45}, 3, {}};
  const Picture picture = drawn(yard);
  const cv::Mat grey = grey_of(picture);
  const cv::Mat shadows = shadow_mask(grey, kShadowThreshold, kPixelM, {});
  const cv::Mat borders = far_borders(grey, shadows, yard.sun, kPixelM, {});
  const auto count_in = [&](double west_m, double south_m, double east_m, double north_m) {
    const Eigen::Vector2d from = picture.grid.pixel_from_ground({west_m, north_m});
    const Eigen::Vector2d to = picture.grid.pixel_from_ground({east_m, south_m});
    const cv::Rect box(cv::Point(static_cast<int>(from.x()), static_cast<int>(from.y())),
                       cv::Point(static_cast<int>(to.x()), static_cast<int>(to.y())));
    return cv::countNonZero(borders(box));
  };
  EXPECT_GT(count_in(15, 7.5, 25, 8.5), 200);
  EXPECT_EQ(count_in(25.5, 8.8, 26.5, 10.8), 0);
  EXPECT_EQ(count_in(13.5, 8.8, 14.5, 10.8), 0);
  EXPECT_EQ(count_in(0, 0, 40, 7.5), 0);
  EXPECT_EQ(count_in(15, 8.6, 25, 10.5), 0);
}

TEST(Shadows, NarrowDarkLinesAreNone) {
  cv::Mat grey(200, 200, CV_8UC1, cv::Scalar::all(150));
  cv::line(grey, {0, 100}, {199, 100}, cv::Scalar::all(30), 3);
  EXPECT_EQ(cv::countNonZero(shadow_mask(grey, kShadowThreshold, kPixelM, {})), 0);
}

TEST(Clutter, RoughAndGreenAreMasked) {
  Yard yard = one_house();
  yard.trees = {{33, 24}};
  const Picture picture = drawn(yard);
  const Eigen::Vector2d tree = picture.grid.pixel_from_ground({33, 24});
  const cv::Rect on_tree(static_cast<int>(tree.x()) - 8, static_cast<int>(tree.y()) - 8, 16, 16);
  const cv::Mat rough = rough_mask(grey_of(picture), kPixelM, {});
  const cv::Mat green = green_mask(picture, {});
  EXPECT_GT(cv::countNonZero(rough(on_tree)), 200);
  EXPECT_GT(cv::countNonZero(green(on_tree)), 200);
  for (const WallLine& wall : walls_of(kHouse)) {
    EXPECT_EQ(share_beside(rough, picture.grid, wall, 0), 0);
    EXPECT_EQ(share_beside(green, picture.grid, wall, 0), 0);
  }
}

// Grey ground with noise within the mask.
cv::Mat noise_within(const cv::Mat& mask) {
  cv::Mat grey(mask.size(), CV_8UC1, cv::Scalar::all(128));
  cv::Mat noise(mask.size(), CV_8UC1);
  cv::RNG(5).fill(noise, cv::RNG::UNIFORM, 0, 256);
  noise.copyTo(grey, mask);
  return grey;
}

TEST(Clutter, WhatIsSmallIsNone) {
  cv::Mat spot = cv::Mat::zeros(300, 300, CV_8UC1);
  spot(cv::Rect(130, 130, 20, 20)).setTo(255);
  EXPECT_EQ(cv::countNonZero(rough_mask(noise_within(spot), kPixelM, {})), 0);
  spot(cv::Rect(100, 100, 100, 100)).setTo(255);
  EXPECT_GT(cv::countNonZero(rough_mask(noise_within(spot), kPixelM, {})), 8000);
  Picture picture = drawn({{20, 20}, {}, {}, 0, {}});
  picture.bgr.setTo(cv::Scalar::all(128));
  for (int x = 10; x < 200; x += 10) picture.bgr.at<cv::Vec3b>(x, x) = {0, 255, 0};
  EXPECT_EQ(cv::countNonZero(green_mask(picture, {})), 0);
}

TEST(Clutter, NarrowGapsAreClosed) {
  cv::Mat stripes = cv::Mat::zeros(300, 300, CV_8UC1);
  for (int x = 0; x < 300; x += 20) stripes.colRange(x, std::min(x + 10, 300)).setTo(255);
  const cv::Mat rough = rough_mask(noise_within(stripes), kPixelM, {});
  EXPECT_EQ(cv::countNonZero(rough.colRange(20, 270) == 0), 0);
}

TEST(Clutter, GreyPicturesHaveNoGreen) {
  Picture picture = drawn(one_house());
  cv::cvtColor(grey_of(picture), picture.bgr, cv::COLOR_GRAY2BGR);
  EXPECT_EQ(cv::countNonZero(green_mask(picture, {})), 0);
}

TEST(Clutter, WallsInGrassKeepTheirEdges) {
  Picture picture = flat_roof_in_grass();
  const cv::Mat green = green_mask(picture, {});
  const cv::Mat inner = within(green, kPixelM, {});
  cv::Mat edges = edge_maps(picture, gradient_of(picture, {}), {}).back();
  const int all = cv::countNonZero(edges);
  EXPECT_GT(all, 350);  // of the roof's outline
  EXPECT_EQ(cv::countNonZero(edges & inner), 0);
  EXPECT_GT(cv::countNonZero(inner), 9 * cv::countNonZero(green) / 10);
}

TEST(ProgressiveHough, FindsEveryWallTheLongestFirst) {
  for (const double turn_deg : {20.0, 0.0, 1.0, 45.0, 90.0, 135.0}) {
    SCOPED_TRACE(turn_deg);
    const House house{{20, 15}, 12, 8, turn_deg};
    const Picture picture = drawn({{40, 30}, {house}, {}, 0, {}});
    const WallLines lines = lines_of(picture, edge_maps(picture, gradient_of(picture, {}), {}));
    ASSERT_EQ(lines.size(), 4U);
    for (const WallLine& wall : walls_of(house)) EXPECT_TRUE(is_found(wall, lines, 0.15));
    EXPECT_GT(lines[0].length_m(), 11);
    EXPECT_GT(lines[1].length_m(), 11);
    EXPECT_LT(lines[2].length_m(), 9);
  }
}

TEST(ProgressiveHough, ALineOfAStrictMapIsNotFoundAgainInALooseOne) {
  const Picture picture = drawn({{40, 30}, {kHouse}, {}, 0, {}});
  const cv::Mat map = edge_maps(picture, gradient_of(picture, {}), {}).front();
  EXPECT_EQ(lines_of(picture, {map}).size(), lines_of(picture, {map, map, map}).size());
}

TEST(ProgressiveHough, BridgesAShortGapAndNoLongOne) {
  const Picture picture = drawn({{40, 30}, {House{{20, 15}, 30, 8, 0}}, {}, 0, {}});
  cv::Mat map = edge_maps(picture, gradient_of(picture, {}), {}).front();
  const auto count_long = [&](int gap_px) {
    cv::Mat cut = map.clone();
    cut.colRange(200, 200 + gap_px).setTo(0);
    const WallLines lines = lines_of(picture, {cut});
    return std::count_if(lines.begin(), lines.end(),
                         [](const WallLine& line) { return line.length_m() > 25; });
  };
  EXPECT_EQ(count_long(4), 2);
  EXPECT_EQ(count_long(12), 0);
}

TEST(ProgressiveHough, ALineOfDashesNeedsEnoughOfThem) {
  const Picture picture = drawn({{40, 30}, {House{{20, 15}, 30, 8, 0}}, {}, 0, {}});
  const cv::Mat map = edge_maps(picture, gradient_of(picture, {}), {}).front();
  const auto count_long = [&](int dash_px, int gap_px) {
    cv::Mat cut = map.clone();
    for (int x = 0; x + gap_px <= cut.cols; x += dash_px + gap_px) {
      cut.colRange(x, x + gap_px).setTo(0);
    }
    const WallLines lines = lines_of(picture, {cut});
    return std::count_if(lines.begin(), lines.end(),
                         [](const WallLine& line) { return line.length_m() > 5; });
  };
  EXPECT_GE(count_long(6, 2), 2);
  EXPECT_EQ(count_long(3, 4), 0);
}

// Narrow bars of 1 to 12 m; the longest are found first, to the resolution of the rounds.
TEST(ProgressiveHough, LinesComeByTheirLength) {
  Picture picture = drawn({{40, 30}, {}, {}, 0, {}});
  picture.bgr.setTo(cv::Scalar::all(90));
  const int lengths_px[] = {30, 120, 10, 70, 20, 100, 50, 40, 60, 80, 11, 110};
  int y = 10;
  for (const int length_px : lengths_px) {
    picture.bgr(cv::Rect(100, y, length_px, 8)).setTo(cv::Scalar::all(200));
    y += 24;
  }
  const WallLines lines =
      lines_of(picture, {edge_maps(picture, gradient_of(picture, {}), {}).front()});
  ASSERT_GE(lines.size(), 18U);
  double least_m = lines.front().length_m();
  for (const WallLine& line : lines) {
    EXPECT_GT(line.length_m(), 1.3);
    EXPECT_LT(line.length_m(), 1.6 * least_m);
    least_m = std::min(least_m, line.length_m());
  }
}

TEST(ProgressiveHough, DenseEdgesAskForLongerLines) {
  Picture picture = drawn({{40, 30}, {}, {}, 0, {}});
  cv::RNG random(3);
  random.fill(picture.bgr, cv::RNG::UNIFORM, 0, 255);
  const std::vector<cv::Mat> maps = edge_maps(picture, gradient_of(picture, {}), {});
  HoughSettings indifferent;
  indifferent.dense_share = 1;
  EXPECT_LT(4 * lines_of(picture, maps).size(), lines_of(picture, maps, indifferent).size());
}

TEST(ProgressiveHough, TheSeedDecides) {
  Yard yard = one_house();
  yard.trees = {{33, 24}, {7, 7}};
  const Picture picture = drawn(yard);
  const std::vector<cv::Mat> maps = edge_maps(picture, gradient_of(picture, {}), {});
  const WallLines once = lines_of(picture, maps);
  const WallLines again = lines_of(picture, maps);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].begin_m, again[i].begin_m);
    EXPECT_EQ(once[i].end_m, again[i].end_m);
  }
  HoughSettings other;
  other.seed = 2;
  const WallLines in_another_order = lines_of(picture, maps, other);
  const bool is_same = std::equal(once.begin(), once.end(), in_another_order.begin(),
                                  in_another_order.end(), [](const WallLine& a, const WallLine& b) {
                                    return a.begin_m == b.begin_m && a.end_m == b.end_m;
                                  });
  EXPECT_FALSE(is_same);
}

TEST(PlainHough, FindsLinesOfOneMap) {
  const Picture picture = drawn({{40, 30}, {House{{20, 15}, 12, 8, 0}}, {}, 0, {}});
  EXPECT_GE(
      plain_hough(edge_maps(picture, gradient_of(picture, {}), {}).front(), kPixelM, {}).size(),
      2U);
}

TEST(Segmentation, ColoursAndKindsPartRegions) {
  cv::Mat lab(100, 100, CV_32FC3, cv::Scalar(50, 0, 0));
  cv::Mat kinds = cv::Mat::zeros(lab.size(), CV_8UC1);
  lab(cv::Rect(20, 20, 40, 40)).setTo(cv::Scalar(60, 40, 30));
  kinds.colRange(80, 100).setTo(1);
  lab(cv::Rect(70, 70, 4, 4)).setTo(cv::Scalar(90, 0, 0));  // too small to stay
  const Segmentation found = segmented(lab, kinds, 0.2, {});
  EXPECT_EQ(found.count, 3);
  const auto label = [&](int x, int y) { return found.labels.at<int>(y, x); };
  EXPECT_NE(label(30, 30), label(10, 10));
  EXPECT_NE(label(90, 50), label(10, 10));
  EXPECT_EQ(label(71, 71), label(10, 10));
}

TEST(Segmentation, PixelsAtACornerAreNeighbours) {
  cv::Mat lab(60, 60, CV_32FC3, cv::Scalar(50, 0, 0));
  lab(cv::Rect(10, 10, 20, 20)).setTo(cv::Scalar(80, 40, 0));
  lab(cv::Rect(30, 30, 20, 20)).setTo(cv::Scalar(80, 40, 0));
  lab(cv::Rect(0, 30, 30, 30)).setTo(cv::Scalar(20, -40, 0));
  const cv::Mat kinds = cv::Mat::zeros(lab.size(), CV_8UC1);
  const Segmentation found = segmented(lab, kinds, 0.2, {});
  EXPECT_EQ(found.count, 3);
  EXPECT_EQ(found.labels.at<int>(20, 20), found.labels.at<int>(40, 40));
}

// Rough ground is one region; even ground is split at a step smaller than the grain of the rough.
TEST(Segmentation, ARegionGrowsByItsOwnContrast) {
  cv::Mat lab(60, 120, CV_32FC3, cv::Scalar(50, 0, 0));
  cv::Mat noise(60, 60, CV_32FC1);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, -6, 6);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) lab.at<cv::Vec3f>(y, x)[0] += noise.at<float>(y, x);
  }
  lab.colRange(90, 120).setTo(cv::Scalar(54, 0, 0));
  const cv::Mat kinds = cv::Mat::zeros(lab.size(), CV_8UC1);
  const Segmentation found = segmented(lab, kinds, 0.2, {});
  EXPECT_EQ(found.labels.at<int>(30, 30), found.labels.at<int>(10, 10));
  EXPECT_EQ(found.labels.at<int>(30, 30), found.labels.at<int>(50, 50));
  EXPECT_NE(found.labels.at<int>(30, 80), found.labels.at<int>(30, 100));
}

// A small region would merge with more than that; the large one next to it would not.
TEST(Segmentation, BothRegionsMustAgreeToJoin) {
  cv::Mat lab(60, 60, CV_32FC3, cv::Scalar(50, 0, 0));
  lab(cv::Rect(20, 20, 3, 3)).setTo(cv::Scalar(54, 0, 0));
  const cv::Mat kinds = cv::Mat::zeros(lab.size(), CV_8UC1);
  EXPECT_EQ(segmented(lab, kinds, 0.2, {60, 0}).count, 2);
  EXPECT_EQ(segmented(lab, kinds, 0.2, {60, 1}).count, 1);
}

TEST(Regions, ARoofIsMeasured) {
  const House house{{20, 15}, 12, 8, 0};
  const Picture picture = drawn({{40, 30}, {house}, {300, 45}, 3, {}});
  const RegionMap map = regions_of(picture);
  const auto roof =
      std::min_element(map.regions.begin(), map.regions.end(), [](const auto& a, const auto& b) {
        return std::abs(a.area_m2 - 96) < std::abs(b.area_m2 - 96);
      });
  ASSERT_NE(roof, map.regions.end());
  EXPECT_NEAR(roof->area_m2, 96, 6);
  EXPECT_NEAR(roof->length_m, 12, 1);
  EXPECT_NEAR(roof->width_m, 8, 1);
  EXPECT_LT(roof->texture, 3);  // standard deviation, not the lightness itself
  EXPECT_NEAR(roof->mean_lab[0], 46, 4);
  const Eigen::Vector2d middle = map.grid.pixel_from_ground(house.middle_m);
  const auto outward = std::count_if(
      roof->outline.begin(), roof->outline.end(),
      [&](const OutlinePoint& point) { return point.outward.dot(point.at_px - middle) > 0; });
  EXPECT_GT(static_cast<double>(outward), 0.95 * static_cast<double>(roof->outline.size()));
}

TEST(Regions, ShadowsGreenGapsAndSmallOnesAreNone) {
  Yard yard = one_house();
  yard.trees = {{33, 24}};
  yard.sun.azimuth_deg = 0;
  Picture picture = drawn(yard);
  picture.covered.colRange(0, 50).setTo(0);
  picture.bgr(cv::Rect(200, 40, 17, 17)).setTo(cv::Scalar::all(250));  // a car
  const RegionMap map = regions_of(picture);
  const auto kind_at = [&](double x_m, double y_m) {
    const Eigen::Vector2d pixel = map.grid.pixel_from_ground({x_m, y_m});
    return map.kinds.at<std::uint8_t>(static_cast<int>(pixel.y()), static_cast<int>(pixel.x()));
  };
  EXPECT_EQ(kind_at(20, 15), kLit);
  EXPECT_EQ(kind_at(21.5, 8.5), kDark);  // to the south of the house
  EXPECT_EQ(kind_at(33, 24), kGreen);
  EXPECT_EQ(kind_at(3, 15), kDark);
  for (const Region& region : map.regions) {
    EXPECT_GE(region.area_m2, RegionSettings{}.min_area_m2);
    cv::Mat kinds;
    map.kinds.copyTo(kinds, map.labels == region.label);
    EXPECT_EQ(cv::countNonZero(kinds), 0);
  }
}

TEST(Regions, ThereIsAMapAScaleAndTheCoarserHasFewerRegions) {
  RegionSettings settings;
  settings.scales = {20, 400};
  Yard yard = one_house();
  yard.trees = {{33, 24}};
  const std::vector<RegionMap> maps = region_maps(drawn(yard), kShadowThreshold, {}, settings);
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_GT(maps[0].label_count, maps[1].label_count);
}

TEST(Regions, ARoofOfSlowlyChangingLightIsOne) {
  RegionSettings settings;
  settings.scales = {60};
  const RegionMap map = region_maps(flat_roof_in_grass(), kShadowThreshold, {}, settings).front();
  ASSERT_EQ(map.regions.size(), 1U);
  EXPECT_NEAR(map.regions.front().area_m2, 96, 10);
}

// The features of the region in the middle of the yard's house.
RoofFeatures house_features(const Picture& picture, const WallLines& lines, const Sun& sun) {
  const RegionMap map = regions_of(picture);
  const Eigen::Vector2d middle = map.grid.pixel_from_ground(kHouse.middle_m);
  const int label = map.labels.at<int>(static_cast<int>(middle.y()), static_cast<int>(middle.x()));
  const auto house = std::find_if(map.regions.begin(), map.regions.end(),
                                  [&](const Region& region) { return region.label == label; });
  EXPECT_NE(house, map.regions.end());
  return roof_features(map, lines, sun)[static_cast<std::size_t>(house - map.regions.begin())];
}

TEST(Roofs, AHousesShapeIsMeasured) {
  const Yard yard = one_house();
  const auto [area, area2, width, filled, on_lines, shade] =
      house_features(drawn(yard), walls_of(kHouse), yard.sun).shape;
  EXPECT_NEAR(area, std::log(96), 0.1);
  EXPECT_DOUBLE_EQ(area2, area * area);
  EXPECT_NEAR(width, std::log(8), 0.15);
  EXPECT_GT(filled, 0.85);
  EXPECT_LE(filled, 1.05);
  EXPECT_GT(on_lines, 0.85);
  EXPECT_LE(on_lines, 1);
  EXPECT_GT(shade, 0.2);
}

TEST(Roofs, OnlyLinesAlongTheOutlineCount) {
  const Picture picture = drawn(one_house());
  WallLines across;
  for (const WallLine& wall : walls_of(kHouse)) {
    const Eigen::Vector2d side = right_of(direction_of(wall));
    for (double at_m = 0.5; at_m < wall.length_m(); at_m += 0.5) {
      const Eigen::Vector2d on_wall = wall.begin_m + at_m * direction_of(wall);
      across.push_back({on_wall - side, on_wall + side});
    }
  }
  const auto on_lines = [&](const WallLines& lines) {
    return house_features(picture, lines, {300, 45}).shape[4];
  };
  EXPECT_EQ(on_lines({}), 0);
  EXPECT_LT(on_lines(across), 0.3);
}

// It is dark on the side of the shadow; on the other side the ground is lighter than the roof. The
// shadow of a high sun is searched near the roof.
TEST(Roofs, ARoofIsToldByItsShadow) {
  const Yard yard = one_house();
  const Picture picture = drawn(yard);
  const auto shade = [](const Picture& of, const Sun& sun) {
    return house_features(of, {}, sun).shape[5];
  };
  EXPECT_GT(shade(picture, yard.sun), 0.3);
  EXPECT_LT(shade(picture, {120, 45}), 0);
  Yard noon = yard;
  noon.shadow_m = 0.6;
  noon.sun.elevation_deg = 75;
  EXPECT_GT(shade(drawn(noon), noon.sun), shade(drawn(noon), {300, 45}));
}

TEST(Roofs, AHousesLooksAreMeasured) {
  const auto [texture, green, contrast] = house_features(drawn(one_house()), {}, {300, 45}).looks;
  EXPECT_LT(texture, std::log(4));
  EXPECT_EQ(green, 0);
  EXPECT_GT(contrast, std::log(8));
  Picture in_grass = drawn(one_house());
  const cv::Vec3b roof = in_grass.bgr.at<cv::Vec3b>(150, 200);
  cv::Mat not_roof;
  cv::inRange(in_grass.bgr, cv::Scalar(roof) - cv::Scalar::all(20),
              cv::Scalar(roof) + cv::Scalar::all(20), not_roof);
  in_grass.bgr.setTo(cv::Scalar(50, 120, 60), ~not_roof);
  EXPECT_GT(house_features(in_grass, {}, {300, 45}).looks[1], 0.9);
}

// Two adjacent regions, 10 m square, with these colours; the left one is certainly a roof, the
// other one possibly.
double perhaps_beside_a_roof(const Eigen::Vector3d& left_lab, const Eigen::Vector3d& right_lab,
                             double neighbour_trust) {
  RegionMap map;
  map.grid = {0, 10, 0.2};
  map.labels = cv::Mat::zeros(50, 100, CV_32SC1);
  map.labels.colRange(50, 100).setTo(1);
  map.label_count = 2;
  map.regions.resize(2);
  map.regions[0].mean_lab = left_lab;
  map.regions[1].mean_lab = right_lab;
  map.regions[1].label = 1;
  for (Region& region : map.regions) region.area_m2 = 100;
  std::vector<RoofFeatures> features(2);
  features[0].shape[0] = 4;
  RoofSettings settings;
  settings.shape_bias = 0;
  settings.shape_weights = {1, 0, 0, 0, 0, 0};
  settings.looks_trust = 0;
  settings.neighbour_trust = neighbour_trust;
  return roof_probabilities(map, features, settings)[1];
}

// Two sides of a roof have one colour in any light; in grey pictures only lightness is available.
TEST(Roofs, ARoofsNeighbourOfALikeColourIsOneToo) {
  const Eigen::Vector3d red(50, 40, 30);
  const Eigen::Vector3d grey(50, 0, 0);
  EXPECT_NEAR(perhaps_beside_a_roof(red, red, 0), 0.5, 1e-9);
  EXPECT_GT(perhaps_beside_a_roof(red, red, 2), 0.95);
  EXPECT_GT(perhaps_beside_a_roof(red, {75, 40, 30}, 2), 0.95);
  EXPECT_LT(perhaps_beside_a_roof(red, {50, 10, 60}, 2), 0.55);
  EXPECT_LT(perhaps_beside_a_roof(red, grey, 2), 0.55);
  EXPECT_GT(perhaps_beside_a_roof(grey, {53, 0, 0}, 2), 0.95);
  EXPECT_LT(perhaps_beside_a_roof(grey, {80, 0, 0}, 2), 0.55);
}

TEST(Roofs, ARoofThatOneScaleIsSureOfCounts) {
  const cv::Mat sure(3, 3, CV_32FC1, cv::Scalar::all(1));
  const cv::Mat none = cv::Mat::zeros(3, 3, CV_32FC1);
  EXPECT_FLOAT_EQ(over_scales({none, sure, none, none}).at<float>(1, 1), 0.5F);
  EXPECT_FLOAT_EQ(over_scales({sure, sure}).at<float>(1, 1), 1);
}

TEST(Roofs, LooksOfFewRoofsAreNotTrusted) {
  Yard yard{{80, 60}, {}, {300, 45}, 3, {{40, 30}}};
  for (const double x_m : {15.0, 40.0, 65.0}) yard.houses.push_back({{x_m, 12}, 12, 8, x_m});
  const RegionMap map = regions_of(drawn(yard));
  const std::vector<RoofFeatures> features = roof_features(map, {}, yard.sun);
  const auto probabilities = [&](double looks_trust, double least_roofs) {
    RoofSettings settings;
    settings.looks_trust = looks_trust;
    settings.least_roofs = least_roofs;
    return roof_probabilities(map, features, settings);
  };
  const auto apart = [](const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  };
  const std::vector<double> shape_alone = probabilities(0, 0);
  EXPECT_GT(apart(probabilities(1, 0), shape_alone), 0.1);
  EXPECT_LT(apart(probabilities(1, 1e6), shape_alone), 0.01);
}

TEST(Roofs, AHouseIsOneAndARoadIsNone) {
  Yard yard{{80, 60},
            {{{20, 15}, 12, 8, 20}, {{55, 40}, 14, 9, 70}, {{60, 15}, 10, 8, 0}},
            {300, 45},
            3,
            {}};
  Picture picture = drawn(yard);
  cv::line(picture.bgr, {0, 350}, {799, 420}, cv::Scalar(125, 125, 125), 50);
  const RegionMap map = regions_of(picture, 6);
  WallLines walls;
  for (const House& house : yard.houses) {
    const WallLines of_house = walls_of(house);
    walls.insert(walls.end(), of_house.begin(), of_house.end());
  }
  const RoofSettings settings;
  const cv::Mat roofs = roof_picture(
      map, roof_probabilities(map, roof_features(map, walls, yard.sun), settings), settings);
  const auto at = [&](double x_m, double y_m) {
    const Eigen::Vector2d pixel = map.grid.pixel_from_ground({x_m, y_m});
    return roofs.at<float>(static_cast<int>(pixel.y()), static_cast<int>(pixel.x()));
  };
  for (const House& house : yard.houses) {
    EXPECT_GT(at(house.middle_m.x(), house.middle_m.y()), 0.8);
  }
  EXPECT_LT(at(5, 5), 0.2);
  EXPECT_LT(at(10, 24), 0.2);

  WallLines turned = walls;
  for (WallLine& wall : turned) std::swap(wall.begin_m, wall.end_m);
  turned.push_back({{17, 14}, {23, 16.2}});  // on a roof
  turned.push_back({{2, 5}, {8, 5}});        // on the ground
  const WallLines kept = at_roof_edges(turned, roofs, map.grid, {});
  EXPECT_GE(kept.size(), walls.size() - 1);
  for (const WallLine& line : kept) {
    EXPECT_TRUE(std::any_of(walls.begin(), walls.end(), [&](const WallLine& wall) {
      return wall.begin_m == line.begin_m && wall.end_m == line.end_m;
    }));
  }
}

// The lines of a picture before the stage of roofs.
WallLines lines_before_roofs(const Picture& picture, const Sun& sun, std::set<Stage> without = {}) {
  ExtractionSettings settings;
  settings.without = std::move(without);
  settings.without.insert(Stage::roofs);
  return block_walls(picture, {sun, kShadowThreshold}, settings, StagePictures("", ""));
}

TEST(Block, FarBordersOfShadowsAreLeftOut) {
  const Yard yard{{40, 30}, {House{{20, 15}, 12, 8, 0}}, {0, 45}, 3, {}};
  const Picture picture = drawn(yard);
  const WallLine border{{14, 8}, {26, 8}};
  EXPECT_FALSE(is_found(border, lines_before_roofs(picture, yard.sun), 0.3));
  EXPECT_TRUE(is_found(border, lines_before_roofs(picture, yard.sun, {Stage::shadows}), 0.3));
  for (const WallLine& wall : walls_of(yard.houses.front())) {
    EXPECT_TRUE(is_found(wall, lines_before_roofs(picture, yard.sun), 0.3));
  }
}

// Within trees there are no lines; on their border there may be some.
TEST(Block, TreesAreLeftOutWhetherGreenOrRough) {
  const Yard yard{{30, 20}, {}, {0, 45}, 0, {{8, 10}, {20, 10}}};
  Picture grey = drawn(yard);
  cv::cvtColor(grey_of(grey), grey.bgr, cv::COLOR_GRAY2BGR);
  Picture green = drawn({{30, 20}, {}, {}, 0, {}});  // a meadow with paths
  green.bgr.setTo(cv::Scalar(50, 120, 60));
  for (int y = 40; y < 160; y += 20) {
    green.bgr(cv::Rect(50, y, 200, 8)).setTo(cv::Scalar(40, 90, 50));
  }
  for (const Picture& picture : {green, grey}) {
    const std::size_t without = lines_before_roofs(picture, yard.sun, {Stage::vegetation}).size();
    EXPECT_GE(without, 4U);
    EXPECT_EQ(lines_before_roofs(picture, yard.sun).size(), 0U);
  }
}

TEST(Block, WallsInGrassStay) {
  const WallLines lines = lines_before_roofs(flat_roof_in_grass(), {0, 45});
  for (const WallLine& wall : walls_of(House{{12, 10}, 12, 8, 0})) {
    EXPECT_TRUE(is_found(wall, lines, 0.3));
  }
}

TEST(SunEvidence, ShadowsTellTheAzimuth) {
  for (const double azimuth_deg : {1.0, 10.0, 100.0, 190.0, 315.0, 359.0}) {
    Yard yard{{80, 60}, {}, {azimuth_deg, 45}, 3, {}};
    for (const double x_m : {15.0, 40.0, 65.0}) {
      yard.houses.push_back({{x_m, 15}, 12, 8, x_m});
      yard.houses.push_back({{x_m, 45}, 10, 8, -x_m});
    }
    SunEvidence evidence;
    evidence.add(regions_of(drawn(yard)));
    ASSERT_TRUE(evidence.azimuth_deg().has_value());
    EXPECT_LT(std::abs(std::remainder(*evidence.azimuth_deg() - azimuth_deg, 360)), 6);
  }
}

TEST(SunEvidence, HousesThatAllStandOneWayTellItToo) {
  for (const double azimuth_deg : {95.0, 140.0, 185.0}) {
    Yard yard{{80, 60}, {}, {azimuth_deg, 45}, 4, {}};
    for (const double x_m : {15.0, 40.0, 65.0}) {
      yard.houses.push_back({{x_m, 15}, 14, 7, -30});
      yard.houses.push_back({{x_m, 45}, 14, 7, -30});
    }
    SunEvidence evidence;
    evidence.add(regions_of(drawn(yard)));
    ASSERT_TRUE(evidence.azimuth_deg().has_value());
    EXPECT_NEAR(*evidence.azimuth_deg(), azimuth_deg, 5);
  }
}

TEST(SunEvidence, NothingIsKnownWithoutShadows) {
  SunEvidence evidence;
  evidence.add(regions_of(drawn({{40, 30}, {}, {}, 0, {}})));
  EXPECT_FALSE(evidence.azimuth_deg().has_value());
}

TEST(Sun, ShadowsFallAwayFromIt) {
  EXPECT_LT((shadow_direction({90, 45}) - Eigen::Vector2d(-1, 0)).norm(), 1e-9);
  EXPECT_LT((shadow_direction({180, 45}) - Eigen::Vector2d(0, 1)).norm(), 1e-9);
}

}  // namespace
}  // namespace milepost
