#include "client/global/direction_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "client/estimation/robust_weights.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr int kRefinements = 15;
constexpr double kMinMeetingAngleRad = 0.5 * kRadPerDeg;

// The information of a fitting circle, in nats: minus the logarithm of the share of all rotations
// about its middle that would fit as well.
double surprise(const GreatCircle& circle) {
  const double fitting_share = 2 * kMaxMisfitSigmas * circle.turn_sigma_rad / std::numbers::pi;
  return std::max(0.0, -std::log(fitting_share));
}

}  // namespace

bool Zone::contains(const Eigen::Vector3d& direction) const {
  const double cosine = std::abs(axis.dot(direction));
  return cosine <= std::cos(min_rad) && cosine >= std::cos(max_rad);
}

double misfit_sigmas(const GreatCircle& circle, const Eigen::Vector3d& direction) {
  return std::abs(circle.normal.dot(direction)) / circle.sigma_rad(direction);
}

double likelihood(std::span<const GreatCircle> circles, const Eigen::Vector3d& direction) {
  double sum = 0;
  for (const GreatCircle& circle : circles) {
    const double part = misfit_sigmas(circle, direction) / kMaxMisfitSigmas;
    if (part < 1) sum += surprise(circle) * (1 - part * part);
  }
  return sum;
}

std::optional<Eigen::Vector3d> strongest_direction(
    std::span<const GreatCircle> circles, std::size_t pairs_of,
    const std::function<bool(const Eigen::Vector3d&)>& is_allowed) {
  std::optional<Eigen::Vector3d> strongest;
  double most = 0;
  const auto paired = circles.first(std::min(pairs_of, circles.size()));
  for (const Eigen::Vector3d& point : intersections(paired, kMinMeetingAngleRad)) {
    if (!is_allowed(point)) continue;
    const double value = likelihood(circles, point);
    if (value <= most) continue;
    most = value;
    strongest = point;
  }
  return strongest;
}

Eigen::Vector3d refined_direction(std::span<const GreatCircle> circles,
                                  std::span<const SquareTo> knowledge,
                                  const Eigen::Vector3d& start) {
  Eigen::Vector3d direction = start;
  for (int round = 0; round < kRefinements; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const GreatCircle& circle : circles) {
      const double sigma = circle.sigma_rad(direction);
      const double weight =
          geman_mcclure_weight(circle.normal.dot(direction) / sigma, kMaxMisfitSigmas / 2);
      information += weight / (sigma * sigma) * circle.normal * circle.normal.transpose();
    }
    for (const SquareTo& known : knowledge) {
      information += known.axis * known.axis.transpose() / (known.sigma_rad * known.sigma_rad);
    }
    const Eigen::Vector3d least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvectors().col(0);
    direction = least.dot(start) < 0 ? Eigen::Vector3d(-least) : least;
  }
  return direction;
}

}  // namespace milepost
