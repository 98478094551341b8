#include "mapper/aerial/roofs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include "mapper/aerial/morphology.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kLineWidthM = 0.8;      // of a straight line, for outlines on it
constexpr double kMaxLineTurnDeg = 25;   // between such a line and the outline
constexpr double kOutsideM = 1;          // from an outline to the samples outside
constexpr double kLowEavesM = 2;         // assumed height of eaves, for the shadow of a roof
constexpr double kMinShadeCosine = 0.5;  // of an outline's normal with the shadow's direction
constexpr double kNeighbourM = 0.6;      // largest gap between neighbouring regions
constexpr double kLikeColour = 6;        // distance in a and b at which colours are dissimilar
constexpr double kLikeGrey = 9;          // the same in L, for a picture without colours
constexpr double kMinColour = 3;         // least distance of a colour from grey
constexpr double kRidge = 5;             // of the logistic regression on appearance
constexpr double kMaxLogOdds = 9;

double log_odds(double probability) {
  const double limit = std::exp(-kMaxLogOdds);
  const double inside = std::clamp(probability, limit, 1 - limit);
  return std::log(inside / (1 - inside));
}

double probability(double odds) { return 1 / (1 + std::exp(-odds)); }

cv::Point nearest_inside(const Eigen::Vector2d& at, const cv::Mat& picture) {
  return {std::clamp(static_cast<int>(std::lround(at.x())), 0, picture.cols - 1),
          std::clamp(static_cast<int>(std::lround(at.y())), 0, picture.rows - 1)};
}

// The angle of the straight line at each pixel of the map, 0 to pi; -1 if there is none.
cv::Mat angles_of(const WallLines& lines, const RegionMap& map) {
  cv::Mat angles(map.labels.size(), CV_32FC1, cv::Scalar::all(-1));
  const int width =
      std::max(1, static_cast<int>(std::lround(kLineWidthM / map.grid.metres_per_pixel)));
  for (const WallLine& line : lines) {
    const Eigen::Vector2d begin = map.grid.pixel_from_ground(line.begin_m);
    const Eigen::Vector2d end = map.grid.pixel_from_ground(line.end_m);
    const double angle = std::atan2(end.y() - begin.y(), end.x() - begin.x());
    const auto point = [](const Eigen::Vector2d& at) {
      return cv::Point(static_cast<int>(std::lround(at.x())),
                       static_cast<int>(std::lround(at.y())));
    };
    cv::line(angles, point(begin), point(end),
             cv::Scalar::all(std::fmod(angle + std::numbers::pi, std::numbers::pi)), width);
  }
  return angles;
}

bool lies_on_line(const OutlinePoint& point, const cv::Mat& angles, double metres_per_pixel) {
  const Eigen::Vector2d at = point.at_px + 0.2 / metres_per_pixel * point.outward;
  const double angle = angles.at<float>(nearest_inside(at, angles));
  if (angle < 0) return false;
  const double along_normal =
      std::abs(point.outward.x() * std::cos(angle) + point.outward.y() * std::sin(angle));
  return along_normal < std::sin(kMaxLineTurnDeg * kRadPerDeg);
}

RoofFeatures features_of(const Region& region, const RegionMap& map, const cv::Mat& angles,
                         const Eigen::Vector2d& shadow_px, double shade_reach_m) {
  double on_lines = 0;
  double shaded_points = 0;
  double shade = 0;
  double green = 0;
  double contrast = 0;
  for (const OutlinePoint& point : region.outline) {
    if (lies_on_line(point, angles, map.grid.metres_per_pixel)) ++on_lines;
    const auto pixel_at = [&](double distance_m) {
      return nearest_inside(point.at_px + distance_m / map.grid.metres_per_pixel * point.outward,
                            map.kinds);
    };
    Eigen::Vector3d outside = Eigen::Vector3d::Zero();
    double lightness = 0;
    for (const double share : {0.6, 1.0}) {
      const cv::Point pixel = pixel_at(share * kOutsideM);
      const auto& lab = map.lab.at<cv::Vec3f>(pixel);
      outside += Eigen::Vector3d(lab[0], lab[1], lab[2]) / 2;
      green += map.kinds.at<std::uint8_t>(pixel) == kGreen ? 0.5 : 0;
      lightness += map.lab.at<cv::Vec3f>(pixel_at(share * shade_reach_m))[0] / 2.0;
    }
    contrast += (outside - region.mean_lab).norm();
    if (point.outward.dot(shadow_px) < kMinShadeCosine) continue;
    ++shaded_points;
    const double own = std::max(region.mean_lab[0], 1.0);
    shade += std::clamp((region.mean_lab[0] - lightness) / own, -1.0, 1.0);
  }
  const double points = std::max<double>(static_cast<double>(region.outline.size()), 1);
  const double ln_area = std::log(region.area_m2);
  return {{ln_area, ln_area * ln_area, std::log(region.width_m),
           region.area_m2 / (region.length_m * region.width_m), on_lines / points,
           shade / std::max(shaded_points, 1.0)},
          {std::log(region.texture + 1), green / points, std::log(contrast / points + 1)}};
}

// Terms of the logistic regression on appearance: colour, its squares and products, and looks.
constexpr int kTerms = 13;
using Terms = Eigen::Matrix<double, kTerms, 1>;

std::vector<Terms> terms_of(const std::vector<Region>& regions,
                            const std::vector<RoofFeatures>& features) {
  Eigen::ArrayXXd looks(6, regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const auto& [texture, green, contrast] = features[i].looks;
    looks.col(static_cast<Eigen::Index>(i)) << regions[i].mean_lab.array(), texture, green,
        contrast;
  }
  looks.colwise() -= looks.rowwise().mean().eval();
  looks.colwise() /= looks.square().rowwise().mean().sqrt().max(1e-6).eval();
  std::vector<Terms> terms(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const auto c = looks.col(static_cast<Eigen::Index>(i));
    terms[i] << c[0], c[1], c[2], c[3], c[4], c[5], c[0] * c[0], c[1] * c[1], c[2] * c[2],
        c[0] * c[1], c[0] * c[2], c[1] * c[2], 1.0;
  }
  return terms;
}

// The weights that minimize log loss with a ridge penalty, by Newton's method. `wanted` are target
// probabilities.
Terms fitted(const std::vector<Terms>& terms, const std::vector<double>& wanted,
             const std::vector<double>& weights) {
  Terms ridge = Terms::Constant(kRidge);
  ridge[kTerms - 1] = 1e-6;  // the bias is free
  Terms solution = Terms::Zero();
  for (int step = 0; step < 8; ++step) {
    Terms slope = ridge.cwiseProduct(solution);
    Eigen::Matrix<double, kTerms, kTerms> curvature = ridge.asDiagonal();
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double now = probability(terms[i].dot(solution));
      slope += weights[i] * (now - wanted[i]) * terms[i];
      curvature += weights[i] * std::max(now * (1 - now), 1e-4) * terms[i] * terms[i].transpose();
    }
    solution -= curvature.ldlt().solve(slope);
  }
  return solution;
}

// 0 for the same colour, 1 for dissimilar colours. Two sides of one roof have the same hue, not the
// same lightness.
double unlikeness(const Region& a, const Region& b, bool in_grey) {
  const Eigen::Vector3d apart = a.mean_lab - b.mean_lab;
  return in_grey ? std::abs(apart[0]) / kLikeGrey : apart.tail<2>().norm() / kLikeColour;
}

// The neighbours of each region, weighted by their share of its border, and less where colours
// differ.
using Neighbours = std::vector<std::map<std::size_t, double>>;

Neighbours neighbours_of(const RegionMap& map) {
  const bool in_grey = std::all_of(
      map.regions.begin(), map.regions.end(),
      [](const Region& region) { return region.mean_lab.tail<2>().norm() < kMinColour; });
  std::vector<int> region_of_label(map.label_count, -1);
  for (std::size_t i = 0; i < map.regions.size(); ++i) {
    region_of_label[map.regions[i].label] = static_cast<int>(i);
  }
  Neighbours neighbours(map.regions.size());
  const int apart = std::max(1, static_cast<int>(kNeighbourM / map.grid.metres_per_pixel));
  const auto meet = [&](const cv::Point& from, const cv::Point& to) {
    const int a = region_of_label[map.labels.at<int>(from)];
    const int b = region_of_label[map.labels.at<int>(to)];
    if (a < 0 || b < 0 || a == b) return;
    ++neighbours[a][static_cast<std::size_t>(b)];
    ++neighbours[b][static_cast<std::size_t>(a)];
  };
  for (int y = 0; y < map.labels.rows; ++y) {
    for (int x = 0; x < map.labels.cols; ++x) {
      if (x + apart < map.labels.cols) meet({x, y}, {x + apart, y});
      if (y + apart < map.labels.rows) meet({x, y}, {x, y + apart});
    }
  }
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    double total = 0;
    for (const auto& [other, border] : neighbours[i]) total += border;
    for (auto& [other, border] : neighbours[i]) {
      const double unlike = unlikeness(map.regions[i], map.regions[other], in_grey);
      border *= std::exp(-unlike * unlike) / total;
    }
  }
  return neighbours;
}

double by_shape(const RoofFeatures& features, const RoofSettings& settings) {
  return std::inner_product(features.shape.begin(), features.shape.end(),
                            settings.shape_weights.begin(), settings.shape_bias);
}

// The mean of the picture on one side of a line, between two distances from it.
double mean_beside(const cv::Mat& picture, const Eigen::Vector2d& begin, const Eigen::Vector2d& end,
                   const Eigen::Vector2d& side, std::span<const double> distances_px) {
  const int steps = std::max(2, static_cast<int>((end - begin).norm()));
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2d on_line = begin + (end - begin) * (i + 0.5) / steps;
    for (const double distance_px : distances_px) {
      sum += picture.at<float>(nearest_inside(on_line + distance_px * side, picture));
    }
  }
  return sum / (steps * static_cast<double>(distances_px.size()));
}

}  // namespace

std::vector<RoofFeatures> roof_features(const RegionMap& map, const WallLines& lines,
                                        const Sun& sun) {
  const cv::Mat angles = angles_of(lines, map);
  const Eigen::Vector2d shadow = shadow_direction(sun);
  const double shade_reach_m =
      std::min(kOutsideM, kLowEavesM / std::tan(sun.elevation_deg * kRadPerDeg));
  std::vector<RoofFeatures> features;
  features.reserve(map.regions.size());
  for (const Region& region : map.regions) {
    features.push_back(features_of(region, map, angles, {shadow.x(), -shadow.y()}, shade_reach_m));
  }
  return features;
}

std::vector<double> roof_probabilities(const RegionMap& map,
                                       const std::vector<RoofFeatures>& features,
                                       const RoofSettings& settings) {
  const std::size_t count = map.regions.size();
  std::vector<double> shape_odds(count);
  std::vector<double> probabilities(count);
  std::vector<double> weights(count);  // mean 1, by the root of the area
  double total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    shape_odds[i] = by_shape(features[i], settings);
    probabilities[i] = probability(shape_odds[i]);
    weights[i] = std::sqrt(map.regions[i].area_m2);
    total += weights[i];
  }
  for (double& weight : weights) weight *= static_cast<double>(count) / total;
  const std::vector<Terms> terms = terms_of(map.regions, features);
  const Neighbours neighbours = neighbours_of(map);
  for (int round = 0; round < settings.rounds; ++round) {
    const Terms looks = fitted(terms, probabilities, weights);
    const double roofs = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
    const double trust = settings.looks_trust * roofs / (roofs + settings.least_roofs);
    double share = 0;
    for (std::size_t i = 0; i < count; ++i) {
      share += weights[i] * probabilities[i] / static_cast<double>(count);
    }
    std::vector<double> next(count);
    for (std::size_t i = 0; i < count; ++i) {
      double around = 0;
      for (const auto& [other, part] : neighbours[i])
        around += part * log_odds(probabilities[other]);
      next[i] = probability(shape_odds[i] + trust * (terms[i].dot(looks) - log_odds(share)) +
                            settings.neighbour_trust * around);
    }
    probabilities = std::move(next);
  }
  return probabilities;
}

cv::Mat roof_picture(const RegionMap& map, const std::vector<double>& probabilities,
                     const RoofSettings& settings) {
  std::vector<float> by_label(map.label_count, 0);
  for (std::size_t i = 0; i < map.regions.size(); ++i) {
    by_label[map.regions[i].label] = static_cast<float>(probabilities[i]);
  }
  cv::Mat picture(map.labels.size(), CV_32FC1);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      picture.at<float>(y, x) = by_label[map.labels.at<int>(y, x)];
    }
  }
  const double metres_per_pixel = map.grid.metres_per_pixel;
  cv::morphologyEx(picture, picture, cv::MORPH_CLOSE, disc(settings.closing_m, metres_per_pixel));
  cv::morphologyEx(picture, picture, cv::MORPH_OPEN, disc(settings.opening_m, metres_per_pixel));
  return picture;
}

cv::Mat over_scales(const std::vector<cv::Mat>& pictures) {
  cv::Mat squares = cv::Mat::zeros(pictures.front().size(), CV_32FC1);
  for (const cv::Mat& picture : pictures) cv::accumulateSquare(picture, squares);
  cv::Mat roots;
  cv::sqrt(squares / static_cast<double>(pictures.size()), roots);
  return roots;
}

WallLines at_roof_edges(const WallLines& lines, const cv::Mat& roofs, const PixelGrid& grid,
                        const RoofEdgeSettings& settings) {
  std::vector<double> distances_px;
  for (int i = 0; i < 4; ++i) {
    const double distance_m = settings.near_m + (settings.far_m - settings.near_m) * i / 3;
    distances_px.push_back(distance_m / grid.metres_per_pixel);
  }
  WallLines walls;
  for (const WallLine& line : lines) {
    const Eigen::Vector2d begin = grid.pixel_from_ground(line.begin_m);
    const Eigen::Vector2d end = grid.pixel_from_ground(line.end_m);
    const Eigen::Vector2d along = (end - begin).normalized();
    const Eigen::Vector2d right(-along.y(), along.x());
    const double difference = mean_beside(roofs, begin, end, right, distances_px) -
                              mean_beside(roofs, begin, end, -right, distances_px);
    if (std::abs(difference) < settings.min_difference) continue;
    walls.push_back(difference > 0 ? line : WallLine{line.end_m, line.begin_m});
  }
  return walls;
}

}  // namespace milepost
