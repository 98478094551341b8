#include "client/localize/landmark_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace milepost {
namespace {

constexpr double kCutoffSigmas = PoseSolverSettings().cutoff;  // of inlier residuals
constexpr double kCellsAcross = 12;  // across the image's width; cells are square
constexpr double kBorderPx = 8;      // in which SIFT detects no features
// A landmark is predicted only where the frame has texture: where it has any feature close enough
// in position and scale that it could be a match.
constexpr double kTexturePx = 12;

struct Weighted {
  double value = 0;
  double weight = 0;
};

// Mixtures of the detection rate of landmarks, and of the variance of their residuals in squared
// sigmas, as measured over recorded drives, original and degraded: at the true pose ...
constexpr std::array<Weighted, 6> kFoundHere = {
    {{0.08, 0.1}, {0.16, 0.1}, {0.3, 0.2}, {0.5, 0.2}, {0.7, 0.2}, {0.86, 0.2}}};
constexpr std::array<Weighted, 4> kVarianceHere = {
    {{0.2, 0.2}, {0.45, 0.3}, {0.8, 0.3}, {1.2, 0.2}}};
// ... and at the best fitting poses elsewhere on the map (DECISIONS 31).
constexpr std::array<Weighted, 5> kFoundElsewhere = {
    {{0.01, 0.15}, {0.03, 0.2}, {0.08, 0.3}, {0.15, 0.25}, {0.3, 0.1}}};
constexpr std::array<Weighted, 4> kVarianceElsewhere = {
    {{0.4, 0.1}, {1.2, 0.25}, {2.5, 0.4}, {6, 0.25}}};

// The log-likelihood of a support for a detection rate and residual lengths with a truncated
// Rayleigh distribution of that variance, up to a constant.
double log_likelihood(const LandmarkSupport& support, double found, double variance) {
  const double normal = variance * (1 - std::exp(-kCutoffSigmas * kCutoffSigmas / (2 * variance)));
  return support.found * (std::log(found) - std::log(normal)) +
         (support.expected - support.found) * std::log(1 - found) -
         support.squared_sigmas / (2 * variance);
}

double log_mixture(const LandmarkSupport& support, std::span<const Weighted> found,
                   std::span<const Weighted> variance) {
  double highest = -1e300;
  std::vector<double> terms;
  for (const Weighted& f : found) {
    for (const Weighted& v : variance) {
      terms.push_back(std::log(f.weight * v.weight) + log_likelihood(support, f.value, v.value));
      highest = std::max(highest, terms.back());
    }
  }
  double sum = 0;
  for (const double term : terms) sum += std::exp(term - highest);
  return highest + std::log(sum);
}

bool is_inside(const Eigen::Vector2d& pixel, const Camera& camera) {
  return pixel.x() >= kBorderPx && pixel.x() < camera.width_px - kBorderPx &&
         pixel.y() >= kBorderPx && pixel.y() < camera.height_px - kBorderPx;
}

// Whether the frame has any feature of about that scale there.
bool is_textured(const CompactFrame& frame, const Eigen::Vector2d& pixel, double scale_px,
                 double max_log_scale) {
  constexpr auto kRadiusPx = static_cast<float>(kTexturePx);
  bool found = false;
  frame.grid.visit_near(
      static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), kRadiusPx, [&](std::size_t f) {
        const Feature& feature = frame.features[f];
        const Eigen::Vector2d off = Eigen::Vector2d(feature.x_px, feature.y_px) - pixel;
        const double change = std::log(feature.scale_px / scale_px);
        found = found || (off.norm() <= kRadiusPx && std::abs(change) <= max_log_scale);
      });
  return found;
}

}  // namespace

LandmarkSupport support_of(const PoseEstimate& estimate, double along_m, const CompactFrame& frame,
                           const std::vector<LocalLandmark>& landmarks, const PoseSolver& solver,
                           const Camera& given, const LandmarkMatchSettings& settings) {
  struct Cell {
    int expected = 0;
    int found = 0;
    double squared_sigmas = 0;
  };
  std::map<std::pair<int, int>, Cell> cells;
  std::map<std::size_t, double> sigmas;  // of the landmarks found
  const std::vector<double> off = solver.pixel_sigmas(estimate.belief.x, estimate.agreeing);
  for (std::size_t i = 0; i < off.size(); ++i) sigmas[estimate.agreeing[i].landmark] = off[i];
  const CameraPose pose = estimate.belief.pose();
  const Pinhole camera = estimate.belief.camera(given.pinhole);
  const Eigen::Matrix3d rotation = camera_from_enu(pose);
  const double cell_px = given.width_px / kCellsAcross;
  LandmarkSupport support;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const LocalLandmark& landmark = landmarks[i];
    if (!landmark.is_of_this_way) continue;
    if (!landmark.along.widened(settings.along_margin_m).contains(along_m)) continue;
    const Eigen::Vector3d seen = rotation * (landmark.enu_m - pose.enu_m);
    if (!(seen.z() > kNearestSeenM)) continue;
    const Eigen::Vector2d pixel = camera.project(seen);
    if (!is_inside(pixel, given)) continue;
    const double scale_px = landmark.size_m * camera.focal_px() / seen.z();
    const auto found = sigmas.find(i);
    if (found == sigmas.end() && !is_textured(frame, pixel, scale_px, settings.max_log_scale))
      continue;
    Cell& cell =
        cells[{static_cast<int>(pixel.x() / cell_px), static_cast<int>(pixel.y() / cell_px)}];
    ++cell.expected;
    ++support.landmarks_expected;
    if (found == sigmas.end()) continue;
    ++cell.found;
    ++support.landmarks_found;
    cell.squared_sigmas += found->second * found->second;
  }
  for (const auto& [place, cell] : cells) {
    support.expected += 1;
    support.found += static_cast<double>(cell.found) / cell.expected;
    support.squared_sigmas += cell.squared_sigmas / cell.expected;
  }
  return support;
}

double log_bayes_factor(const LandmarkSupport& support) {
  return log_mixture(support, kFoundHere, kVarianceHere) -
         log_mixture(support, kFoundElsewhere, kVarianceElsewhere);
}

}  // namespace milepost
