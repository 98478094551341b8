#include "mapper/fusion/tie.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "mapper/fusion/matching.h"

namespace milepost {
namespace {

struct Difference {
  Eigen::Vector3d enu_m;       // b minus a
  Eigen::Vector3d landmark_m;  // where a has it
  Eigen::Matrix3d covariance_m2;
  double squared_distance = 0;  // of the descriptors
  std::size_t a = 0, b = 0;
};

std::vector<ComparedLandmark> exact_ones(const std::vector<PassLandmark>& landmarks,
                                         const LocalFrame& local, const TieSettings& settings,
                                         std::vector<double>& stretch_m) {
  std::vector<ComparedLandmark> exact;
  for (const PassLandmark& each : landmarks) {
    if (each.landmark.depth_sigma_m > settings.max_sigma_m) continue;
    exact.push_back(compared(each.landmark, local));
    stretch_m.push_back(each.stretch_m);
  }
  return exact;
}

// For each landmark of `from` the most similar one of `to` that may be in the same place, if no
// other is about as similar.
std::vector<std::optional<std::size_t>> nearest(const std::vector<ComparedLandmark>& from,
                                                const std::vector<ComparedLandmark>& to,
                                                const TieSettings& settings) {
  constexpr double kMaxRatio = 0.8;     // Lowe's ratio test ...
  constexpr double kSamePlaceM = 0.05;  // ... against landmarks that are not in the same place
  constexpr double kSigmas = 3;
  std::vector<std::optional<std::size_t>> found;
  for (const ComparedLandmark& a : from) {
    std::size_t best = to.size();
    double least = kMaxSquaredDistance;
    double second = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < to.size(); ++i) {
      const ComparedLandmark& b = to[i];
      const double sigma_m = std::sqrt((a.covariance_m2 + b.covariance_m2).trace());
      if ((b.enu_m - a.enu_m).norm() > settings.max_offset_m + kSigmas * sigma_m) continue;
      if (!are_of_one_size(a, b)) continue;
      const double distance = squared_distance(a.descriptor, b.descriptor);
      const bool is_elsewhere =
          best == to.size() || (to[best].enu_m - b.enu_m).norm() > kSamePlaceM;
      if (distance < least) {
        if (best < to.size() && is_elsewhere) second = std::min(second, least);
        least = distance;
        best = i;
      } else if (is_elsewhere) {
        second = std::min(second, distance);
      }
    }
    const bool is_clear = best < to.size() && least <= kMaxRatio * kMaxRatio * second;
    found.push_back(is_clear ? std::optional(best) : std::nullopt);
  }
  return found;
}

std::vector<Difference> differences(const std::vector<ComparedLandmark>& a,
                                    const std::vector<ComparedLandmark>& b,
                                    const TieSettings& settings) {
  const auto b_of_a = nearest(a, b, settings);
  const auto a_of_b = nearest(b, a, settings);
  const Eigen::Matrix3d least =
      settings.min_sigma_m * settings.min_sigma_m * Eigen::Matrix3d::Identity();
  std::vector<Difference> found;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!b_of_a[i] || a_of_b[*b_of_a[i]] != i) continue;
    const ComparedLandmark& other = b[*b_of_a[i]];
    found.push_back({other.enu_m - a[i].enu_m, a[i].enu_m,
                     a[i].covariance_m2 + other.covariance_m2 + least,
                     squared_distance(a[i].descriptor, other.descriptor), i, *b_of_a[i]});
  }
  return found;
}

bool agrees(const Difference& difference, const Eigen::Vector3d& offset_m, double cutoff_sigmas) {
  const Eigen::Vector3d off = difference.enu_m - offset_m;
  return off.dot(difference.covariance_m2.ldlt().solve(off)) < cutoff_sigmas * cutoff_sigmas;
}

// What two drives differ by: a shift, and a turn about the road's direction, up and to the right.
constexpr int kUnknowns = 6;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using UnknownsMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// The Jacobian of a landmark's displacement.
Eigen::Matrix<double, 3, kUnknowns> displacement_by_unknowns(const RoadPlace& place,
                                                             const Eigen::Vector3d& landmark_m) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Matrix<double, 3, kUnknowns> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), place.forward.cross(landmark_m), up.cross(landmark_m),
      place.forward.cross(up).cross(landmark_m);
  return jacobian;
}

// The difference that most others agree with; of the most similar ones.
Eigen::Vector3d most_agreed(const std::vector<Difference>& differences, double cutoff_sigmas) {
  constexpr std::size_t kTried = 60;
  std::vector<const Difference*> order;
  order.reserve(differences.size());
  for (const Difference& difference : differences) order.push_back(&difference);
  std::ranges::stable_sort(order, {},
                           [](const Difference* each) { return each->covariance_m2.trace(); });
  std::size_t most = 0;
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < std::min(kTried, order.size()); ++i) {
    const auto agreeing = static_cast<std::size_t>(
        std::ranges::count_if(differences, [&](const Difference& difference) {
          return agrees(difference, order[i]->enu_m, cutoff_sigmas);
        }));
    if (agreeing <= most) continue;
    most = agreeing;
    best = order[i]->enu_m;
  }
  return best;
}

}  // namespace

std::optional<Tie> tie_of(const std::vector<PassLandmark>& a, const std::vector<PassLandmark>& b,
                          const RoadPlace& place, const TieSettings& settings) {
  std::vector<double> a_m;
  std::vector<double> b_m;
  const auto matched = differences(exact_ones(a, place.local, settings, a_m),
                                   exact_ones(b, place.local, settings, b_m), settings);
  if (matched.size() < settings.min_inliers) return std::nullopt;
  const Eigen::Vector3d turn_sigmas(settings.roll_sigma_rad, settings.turn_sigma_rad,
                                    settings.turn_sigma_rad);
  UnknownsMatrix prior = UnknownsMatrix::Zero();
  prior.diagonal().tail<3>() = turn_sigmas.cwiseAbs2().cwiseInverse();
  Tie tie;
  Unknowns unknowns = Unknowns::Zero();
  unknowns.head<3>() = most_agreed(matched, settings.cutoff_sigmas);
  UnknownsMatrix covariance;
  constexpr int kIterations = 5;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    UnknownsMatrix information = prior;
    Unknowns weighted = Unknowns::Zero();
    std::size_t inliers = 0;
    tie.a.along_m = tie.b.along_m = 0;
    for (const Difference& each : matched) {
      const auto jacobian = displacement_by_unknowns(place, each.landmark_m);
      if (!agrees(each, jacobian * unknowns, settings.cutoff_sigmas)) continue;
      const Eigen::Matrix3d weight = each.covariance_m2.inverse();
      information += jacobian.transpose() * weight * jacobian;
      weighted += jacobian.transpose() * weight * each.enu_m;
      tie.a.along_m += a_m[each.a];
      tie.b.along_m += b_m[each.b];
      ++inliers;
    }
    const auto least_ratio = settings.min_inlier_ratio * static_cast<double>(matched.size());
    if (inliers < settings.min_inliers || static_cast<double>(inliers) < least_ratio)
      return std::nullopt;
    covariance = information.inverse();
    unknowns = covariance * weighted;
    tie.a.along_m /= static_cast<double>(inliers);
    tie.b.along_m /= static_cast<double>(inliers);
  }
  tie.difference = unknowns.head<kErrorAxes>();
  tie.covariance = covariance.topLeftCorner<kErrorAxes, kErrorAxes>();
  tie.covariance.diagonal().head<3>().array() += settings.tie_sigma_m * settings.tie_sigma_m;
  return tie;
}

}  // namespace milepost
