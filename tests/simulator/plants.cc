#include "tests/simulator/plants.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/paint.h"
#include "tests/simulator/solids.h"

namespace milepost::simulator {
namespace {

constexpr int kClumpsPerKind = 4;

const cv::Scalar kLeafColours[Foliage::kKinds] = {{40, 88, 70}, {38, 76, 54}, {50, 98, 86}};

cv::Mat paint_clump(const cv::Scalar& colour, cv::RNG& random) {
  const int side = Foliage::kTexels;
  cv::Mat image(side, side, CV_8UC4, cv::Scalar(colour[0], colour[1], colour[2], 0));
  for (int leaf = 0; leaf < 620; ++leaf) {
    const double angle = random.uniform(0.0, 2 * CV_PI);
    const double radius = side * 0.44 * std::sqrt(random.uniform(0.0, 1.0));
    const cv::Point at(static_cast<int>(side / 2 + radius * std::cos(angle)),
                       static_cast<int>(side / 2 + radius * std::sin(angle)));
    cv::Scalar green = varied(colour * random.uniform(0.5, 1.3), 10, random);
    green[3] = 255;
    cv::ellipse(image, at, {random.uniform(3, 6), random.uniform(1, 4)}, random.uniform(0.0, 360.0),
                0, 360, green, -1);
  }
  return image;
}

cv::Mat paint_hedge(cv::RNG& random) {
  cv::Mat image(160, 480, CV_8UC3, cv::Scalar(22, 52, 38));
  for (int leaf = 0; leaf < 9000; ++leaf) {
    const cv::Point at(random.uniform(0, image.cols), random.uniform(0, image.rows));
    cv::ellipse(image, at, {random.uniform(2, 4), random.uniform(1, 3)}, random.uniform(0.0, 360.0),
                0, 360, varied(cv::Scalar(40, 95, 66) * random.uniform(0.5, 1.4), 14, random), -1);
  }
  return image;
}

cv::Mat paint_bark(cv::RNG& random) {
  cv::Mat image(256, 48, CV_8UC3, cv::Scalar(70, 84, 96));
  for (int streak = 0; streak < 260; ++streak) {
    const int x = random.uniform(0, image.cols);
    const int y = random.uniform(0, image.rows);
    const double shade = random.uniform(0.5, 1.4);
    cv::line(image, {x, y}, {x + random.uniform(-2, 3), y + random.uniform(5, 26)},
             cv::Scalar(70, 84, 96) * shade, 1);
  }
  weather(image, 6, 8, random);
  return image;
}

cv::Mat paint_woods(cv::RNG& random) {
  cv::Mat image(128, 1024, CV_8UC4, cv::Scalar(96, 112, 92, 0));
  for (int depth = 0; depth < 3; ++depth) {
    for (int tree = 0; tree < 120; ++tree) {
      const int x = random.uniform(0, image.cols);
      const int radius = random.uniform(9, 26);
      const int top = 40 + depth * 18 + random.uniform(0, 26);
      cv::Scalar green = varied(cv::Scalar(92, 112, 90) * (1.05 - 0.12 * depth), 10, random);
      green[3] = 255;
      cv::ellipse(image, {x, top}, {radius, radius * 3 / 4}, 0, 0, 360, green, -1);
      cv::rectangle(image, {x - radius * 3 / 4, top}, {x + radius * 3 / 4, image.rows}, green, -1);
    }
  }
  return image;
}

Point any_direction(cv::RNG& random) {
  Point direction(random.gaussian(1), random.gaussian(1), random.gaussian(1));
  const double length = cv::norm(direction);
  return length > 1e-6 ? direction * (1 / length) : Point(0, 0, 1);
}

void add_trunk(Scene& scene, const Tree& tree, const Foliage& foliage) {
  const double radius_m = 0.09 + 0.018 * tree.height_m;
  const double top_m = tree.height_m * 0.62;
  constexpr int kSides = 6;
  for (int i = 0; i < kSides; ++i) {
    const double a = 2 * CV_PI * i / kSides;
    const double b = 2 * CV_PI * (i + 1) / kSides;
    const Point left = tree.foot + Point(std::cos(a), std::sin(a), 0) * radius_m;
    const Point right = tree.foot + Point(std::cos(b), std::sin(b), 0) * radius_m;
    const double width_m = cv::norm(right - left);
    add_wall(scene, left - kUp * 0.3, right - kUp * 0.3, top_m + 0.3, foliage.bark(),
             {static_cast<int>(width_m * 60), static_cast<int>(top_m * 60)});
  }
}

}  // namespace

Foliage::Foliage(std::uint64_t seed)
    : hedge_(painted(paint_hedge, seed + 100)), bark_(painted(paint_bark, seed + 101)) {
  for (int i = 0; i < kKinds * kClumpsPerKind; ++i) {
    const cv::Scalar colour = kLeafColours[i / kClumpsPerKind];
    clumps_.push_back(painted([colour](cv::RNG& random) { return paint_clump(colour, random); },
                              seed + static_cast<std::uint64_t>(i)));
  }
}

const std::shared_ptr<const Texture>& Foliage::clump(int kind, cv::RNG& random) const {
  return clumps_[kind * kClumpsPerKind + random.uniform(0, kClumpsPerKind)];
}

void add_tree(Scene& scene, const Tree& tree, const Foliage& foliage) {
  cv::RNG random = seeded(tree.seed);
  add_trunk(scene, tree, foliage);
  const double half_height_m = tree.height_m * 0.34;
  const Point middle = tree.foot + kUp * (tree.height_m - half_height_m);
  const int clumps = static_cast<int>(26 + 9 * tree.crown_radius_m * tree.crown_radius_m);
  for (int i = 0; i < clumps; ++i) {
    const Point out = any_direction(random);
    const double reach = std::pow(random.uniform(0.0, 1.0), 0.4);
    const Point at = middle + Point(out[0] * tree.crown_radius_m, out[1] * tree.crown_radius_m,
                                    out[2] * half_height_m) *
                                  reach;
    const Point facing = cv::normalize(out + any_direction(random) * 0.9);
    const Point across =
        cv::normalize(facing.cross(std::abs(facing[2]) > 0.9 ? Point(1, 0, 0) : kUp));
    const Point down = facing.cross(across);
    const double side_m = Foliage::kClumpM * random.uniform(0.75, 1.25);
    Surface clump =
        rectangle(at - (across + down) * (side_m / 2), across, down, side_m, side_m,
                  foliage.clump(tree.kind, random), {Foliage::kTexels, Foliage::kTexels});
    clump.normal = cv::normalize(out + kUp * 0.35);
    clump.is_cut_out = true;
    clump.translucency = 0.38F;
    clump.openness = static_cast<float>(0.3 + 0.7 * reach * (0.65 + 0.35 * out[2]));
    scene.surfaces.push_back(clump);
  }
}

void add_far_woods(Scene& scene, const cv::Vec2d& centre, double distance_m, std::uint64_t seed) {
  constexpr int kPieces = 28;
  cv::RNG random = seeded(seed);
  for (int i = 0; i < kPieces; ++i) {
    const double a = 2 * CV_PI * i / kPieces;
    const double b = 2 * CV_PI * (i + 1.05) / kPieces;
    const double reach_m = distance_m * random.uniform(0.9, 1.2);
    const auto texture = painted(paint_woods, random.next());
    const double height_m = random.uniform(24.0, 46.0);
    const Point left(centre[0] - std::cos(a) * reach_m, centre[1] + std::sin(a) * reach_m, -3);
    const Point right(centre[0] - std::cos(b) * reach_m, centre[1] + std::sin(b) * reach_m, -3);
    add_wall(scene, left, right, height_m, texture, {1024, 128});
    scene.surfaces.back().is_cut_out = true;
    scene.surfaces.back().is_distant = true;
    scene.surfaces.back().normal = kUp;
  }
}

}  // namespace milepost::simulator
