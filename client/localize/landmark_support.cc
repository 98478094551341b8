#include "client/localize/landmark_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
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

// Mixtures as measured over recorded drives, original and degraded, and over simulated ones in
// other light and lanes: at the true pose, and at the best fitting poses elsewhere on the map
// (DECISIONS 31). Of the detection rate of landmarks ...
struct Rate {
  double found = 0;
  double weight = 0;
};
constexpr std::array<Rate, 6> kRatesHere = {
    {{0.08, 0.1}, {0.16, 0.1}, {0.3, 0.2}, {0.5, 0.2}, {0.7, 0.2}, {0.86, 0.2}}};
constexpr std::array<Rate, 5> kRatesElsewhere = {
    {{0.01, 0.15}, {0.03, 0.2}, {0.08, 0.3}, {0.15, 0.25}, {0.3, 0.1}}};

// ... and of their residuals: right matches have a Rayleigh distribution of this variance in
// squared sigmas, truncated at the cutoff; wrong ones are spread evenly over the area within it.
struct Residuals {
  double variance = 0;
  double wrong = 0;  // share of matches
  double weight = 0;
};
constexpr std::array<Residuals, 5> kResidualsHere = {
    {{0.05, 0.1, 0.2}, {0.1, 0.25, 0.3}, {0.25, 0.25, 0.25}, {0.5, 0.3, 0.15}, {1, 0.3, 0.1}}};
constexpr std::array<Residuals, 5> kResidualsElsewhere = {
    {{0.1, 0.3, 0.03}, {0.45, 0.6, 0.27}, {0.8, 0.4, 0.3}, {1.2, 0.4, 0.25}, {2.5, 0.4, 0.15}}};

using LogProbabilities = std::array<double, LandmarkSupport::kResidualBins>;

constexpr double kBinSigmas = kCutoffSigmas / LandmarkSupport::kResidualBins;

LogProbabilities log_probabilities(const Residuals& residuals) {
  const auto right_within = [&](double sigmas) {
    return std::expm1(-sigmas * sigmas / (2 * residuals.variance)) /
           std::expm1(-kCutoffSigmas * kCutoffSigmas / (2 * residuals.variance));
  };
  const auto within = [&](double sigmas) {
    return (1 - residuals.wrong) * right_within(sigmas) +
           residuals.wrong * sigmas * sigmas / (kCutoffSigmas * kCutoffSigmas);
  };
  LogProbabilities logs;
  for (std::size_t bin = 0; bin < logs.size(); ++bin) {
    const double from_sigmas = static_cast<double>(bin) * kBinSigmas;
    logs[bin] = std::log(within(from_sigmas + kBinSigmas) - within(from_sigmas));
  }
  return logs;
}

double log_of_sum(std::span<const double> logs) {
  const double highest = *std::ranges::max_element(logs);
  double sum = 0;
  for (const double log : logs) sum += std::exp(log - highest);
  return highest + std::log(sum);
}

template <std::size_t kCount>
double log_likelihood(const LandmarkSupport& support, const std::array<Rate, kCount>& mixture) {
  std::array<double, kCount> terms;
  std::ranges::transform(mixture, terms.begin(), [&](const Rate& rate) {
    return std::log(rate.weight) + support.found * std::log(rate.found) +
           (support.expected - support.found) * std::log(1 - rate.found);
  });
  return log_of_sum(terms);
}

template <std::size_t kCount>
double log_likelihood(const LandmarkSupport& support,
                      const std::array<Residuals, kCount>& mixture) {
  std::array<double, kCount> terms;
  std::ranges::transform(mixture, terms.begin(), [&](const Residuals& residuals) {
    const LogProbabilities logs = log_probabilities(residuals);
    return std::inner_product(logs.begin(), logs.end(), support.by_residual.begin(),
                              std::log(residuals.weight));
  });
  return log_of_sum(terms);
}

// Whether the frame shows a pixel of the pinhole.
bool is_inside(const Eigen::Vector2d& pixel, const Camera& camera) {
  const auto shown = camera.image_from_pinhole(pixel);
  return shown && shown->x() >= kBorderPx && shown->x() < camera.width_px - kBorderPx &&
         shown->y() >= kBorderPx && shown->y() < camera.height_px - kBorderPx;
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
    std::array<int, LandmarkSupport::kResidualBins> by_residual{};
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
    const auto bin = static_cast<std::size_t>(found->second / kBinSigmas);
    ++cell.by_residual[std::min(bin, LandmarkSupport::kResidualBins - 1)];
  }
  for (const auto& [place, cell] : cells) {
    support.expected += 1;
    support.found += static_cast<double>(cell.found) / cell.expected;
    for (std::size_t bin = 0; bin < cell.by_residual.size(); ++bin) {
      support.by_residual[bin] += static_cast<double>(cell.by_residual[bin]) / cell.expected;
    }
  }
  return support;
}

double log_bayes_factor(const LandmarkSupport& support) {
  return log_likelihood(support, kRatesHere) - log_likelihood(support, kRatesElsewhere) +
         log_likelihood(support, kResidualsHere) - log_likelihood(support, kResidualsElsewhere);
}

}  // namespace milepost
