#include "mapper/landmarks/triangulation.h"

#include <Eigen/Dense>

#include "schema/geo/ray_triangulation.h"

namespace milepost {
namespace {

constexpr int kMaxIterations = 10;
constexpr double kConvergedM = 1e-4;

using Jacobian = Eigen::Matrix<double, 2, 3>;

std::optional<Eigen::Vector3d> nearest_to_rays(const FeatureTrack& track,
                                               const std::vector<CameraPose>& poses,
                                               const Pinhole& camera) {
  const Eigen::Vector3d centre = poses[track.front().frame].enu_m;
  RayTriangulation rays;
  for (const PixelObservation& observation : track) {
    const CameraPose& pose = poses[observation.frame];
    const Eigen::Vector3d ray = camera_from_enu(pose).transpose() *
                                camera.unproject(observation.pixel.x(), observation.pixel.y());
    rays.add(pose.enu_m - centre, ray.normalized());
  }
  const auto met = rays.point();
  if (!met) return std::nullopt;
  return centre + met->point_m;
}

// The normal equations of a Gauss-Newton step.
struct Normal {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double squares_px2 = 0;
};

std::optional<Normal> normal_at(const Eigen::Vector3d& enu_m, const FeatureTrack& track,
                                const std::vector<CameraPose>& poses, const Pinhole& camera) {
  Normal normal;
  for (const PixelObservation& observation : track) {
    const CameraPose& pose = poses[observation.frame];
    const Eigen::Matrix3d rotation = camera_from_enu(pose);
    const Eigen::Vector3d seen = rotation * (enu_m - pose.enu_m);
    if (!(seen.z() > kNearestSeenM)) return std::nullopt;
    const double weight = 1 / observation.magnification;
    const Jacobian by_point = weight * camera.projection_jacobian(seen) * rotation;
    const Eigen::Vector2d residual = weight * (observation.pixel - camera.project(seen));
    normal.matrix += by_point.transpose() * by_point;
    normal.gradient += by_point.transpose() * residual;
    normal.squares_px2 += residual.squaredNorm();
  }
  return normal;
}

}  // namespace

std::optional<TriangulatedPoint> triangulate(const FeatureTrack& track,
                                             const std::vector<CameraPose>& poses,
                                             const Pinhole& camera, double pixel_sigma_px) {
  const auto start = nearest_to_rays(track, poses, camera);
  if (!start) return std::nullopt;
  TriangulatedPoint placed;
  placed.enu_m = *start;
  std::optional<Normal> normal = normal_at(placed.enu_m, track, poses, camera);
  bool converged = false;  // false if the rays are parallel
  for (int i = 0; normal && !converged && i < kMaxIterations; ++i) {
    const Eigen::Vector3d step = normal->matrix.ldlt().solve(normal->gradient);
    placed.enu_m += step;
    normal = normal_at(placed.enu_m, track, poses, camera);
    converged = step.norm() < kConvergedM;
  }
  if (!normal || !converged) return std::nullopt;
  const Eigen::FullPivLU<Eigen::Matrix3d> inverse(normal->matrix);
  if (!inverse.isInvertible()) return std::nullopt;
  placed.covariance_m2 = pixel_sigma_px * pixel_sigma_px * inverse.inverse();
  placed.rms_px = std::sqrt(normal->squares_px2 / static_cast<double>(track.size()));
  return placed;
}

}  // namespace milepost
