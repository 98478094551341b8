#include "mapper/landmarks/triangulation.h"

#include <Eigen/Dense>

#include "schema/geo/rays.h"

namespace milepost {
namespace {

constexpr int kMaxIterations = 10;
constexpr double kConvergedM = 1e-4;

using Jacobian = Eigen::Matrix<double, 2, 3>;

std::optional<Eigen::Vector3d> nearest_to_rays(const PixelTrack& track,
                                               const std::vector<CameraPose>& poses,
                                               const Pinhole& camera) {
  const Eigen::Vector3d centre = poses[track.front().frame].enu_m;
  MeetingRays rays;
  for (const Sight& sight : track) {
    const CameraPose& pose = poses[sight.frame];
    const Eigen::Vector3d ray =
        camera_from_enu(pose).transpose() * camera.ray_of(sight.pixel.x(), sight.pixel.y());
    rays.add(pose.enu_m - centre, ray.normalized());
  }
  const auto met = rays.point();
  if (!met) return std::nullopt;
  return centre + met->point_m;
}

// Sums of a Gauss-Newton step.
struct Normal {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double squares_px2 = 0;
};

std::optional<Normal> normal_at(const Eigen::Vector3d& enu_m, const PixelTrack& track,
                                const std::vector<CameraPose>& poses, const Pinhole& camera) {
  Normal normal;
  for (const Sight& sight : track) {
    const CameraPose& pose = poses[sight.frame];
    const Eigen::Matrix3d rotation = camera_from_enu(pose);
    const Eigen::Vector3d seen = rotation * (enu_m - pose.enu_m);
    if (!(seen.z() > kNearestSeenM)) return std::nullopt;
    const Jacobian by_point = camera.pixel_by_point(seen) * rotation;
    const Eigen::Vector2d residual = sight.pixel - camera.pixel_of(seen);
    normal.matrix += by_point.transpose() * by_point;
    normal.gradient += by_point.transpose() * residual;
    normal.squares_px2 += residual.squaredNorm();
  }
  return normal;
}

}  // namespace

std::optional<PlacedPoint> triangulate(const PixelTrack& track,
                                       const std::vector<CameraPose>& poses, const Pinhole& camera,
                                       double pixel_sigma_px) {
  const auto start = nearest_to_rays(track, poses, camera);
  if (!start) return std::nullopt;
  PlacedPoint placed;
  placed.enu_m = *start;
  std::optional<Normal> normal = normal_at(placed.enu_m, track, poses, camera);
  bool converged = false;  // towards no point where the rays are parallel
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
