#include "client/localize/pose_consensus.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>

namespace milepost {
namespace {

// The number of pairs to draw until, with this confidence, one of them consists of inliers only,
// for a given inlier ratio (RANSAC).
double enough_samples(double agreeing_part, double confidence) {
  return std::log(1 - confidence) / std::log1p(-std::min(0.999, agreeing_part * agreeing_part));
}

}  // namespace

std::optional<PoseEstimate> estimate_by_consensus(const PoseSolver& solver,
                                                  const PoseBelief& before,
                                                  const std::vector<LandmarkMatch>& matches,
                                                  const ConsensusSettings& settings) {
  if (matches.size() < 2) return std::nullopt;
  const StateMatrix before_information = before.P.inverse();
  std::mt19937 draws(settings.seed);
  StateVector best = before.x;
  std::ptrdiff_t most = 0;
  double samples = settings.samples;
  for (int i = 0; i < samples; ++i) {
    const std::size_t a = draws() % matches.size();
    const std::size_t b = draws() % matches.size();
    if (a == b) continue;
    const StateVector proposed =
        solver.hypothesis(before, before_information, {matches[a], matches[b]});
    const auto agreeing =
        std::ranges::count_if(solver.pixel_sigmas(proposed, matches),
                              [&](double sigmas) { return sigmas < settings.agreement_sigmas; });
    if (agreeing <= most) continue;
    most = agreeing;
    best = proposed;
    samples = std::min(
        samples, enough_samples(static_cast<double>(most) / static_cast<double>(matches.size()),
                                settings.confidence));
  }
  return solver.estimate(before, best, matches);
}

std::vector<PositionEstimate> along_by_scale(const std::vector<LandmarkMatch>& matches,
                                             const std::vector<Feature>& features,
                                             const std::vector<LocalLandmark>& landmarks,
                                             const Pinhole& camera, double scale_sigma) {
  std::vector<PositionEstimate> estimates;
  estimates.reserve(matches.size());
  for (const LandmarkMatch& match : matches) {
    const LocalLandmark& landmark = landmarks[match.landmark];
    const double depth_m = landmark.size_m * camera.focal_px() / features[match.feature].scale_px;
    const double sigma = std::hypot(scale_sigma, landmark.size_sigma);
    estimates.push_back({landmark.mapped_at_m + landmark.mapped_ahead_m - depth_m,
                         std::hypot(depth_m * sigma, landmark.depth_sigma_m)});
  }
  return estimates;
}

}  // namespace milepost
