#include "mapper/landmarks/adjustment.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "mapper/landmarks/triangulation.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kFarthestM = 300;

using PoseBlock = std::array<double, 6>;  // east, north, up, heading, pitch, roll

PoseBlock block_from(const CameraPose& pose) {
  return {pose.enu_m.x(),   pose.enu_m.y(), pose.enu_m.z(),
          pose.heading_rad, pose.pitch_rad, pose.roll_rad};
}

template <class Scalar>
CameraPoseOf<Scalar> pose_from(const Scalar* block) {
  return {{block[0], block[1], block[2]}, block[3], block[4], block[5]};
}

// Reprojection error: a point's image minus the observed pixel.
struct ImageError {
  Eigen::Vector2d pixel;
  Pinhole camera;
  double sigma_px;

  template <class Scalar>
  bool operator()(const Scalar* pose, const Scalar* point, Scalar* residual) const {
    const Eigen::Matrix<Scalar, 3, 1> enu_m(point[0], point[1], point[2]);
    const Eigen::Matrix<Scalar, 3, 1> seen = point_in_camera(pose_from(pose), enu_m);
    if (seen.z() < Scalar(0.1)) return false;
    const Eigen::Matrix<Scalar, 2, 1> image = camera.project(seen);
    residual[0] = (image.x() - pixel.x()) / sigma_px;
    residual[1] = (image.y() - pixel.y()) / sigma_px;
    return true;
  }
};

// Deviation of a pose from the recorded one.
struct RecordError {
  PoseBlock recorded;
  AdjustmentSettings settings;

  template <class Scalar>
  bool operator()(const Scalar* pose, const Scalar* mounting_yaw, Scalar* residual) const {
    for (int i = 0; i < 3; ++i) residual[i] = (pose[i] - recorded[i]) / settings.position_sigma_m;
    const double tilt_rad = settings.tilt_sigma_deg * kRadPerDeg;
    residual[3] =
        (pose[3] - recorded[3] - *mounting_yaw) / (settings.heading_sigma_deg * kRadPerDeg);
    residual[4] = (pose[4] - recorded[4]) / tilt_rad;
    residual[5] = (pose[5] - recorded[5]) / tilt_rad;
    return true;
  }
};

struct MountingError {
  double sigma_rad;

  template <class Scalar>
  bool operator()(const Scalar* mounting_yaw, Scalar* residual) const {
    residual[0] = *mounting_yaw / sigma_rad;
    return true;
  }
};

struct TriangulatedTrack {
  const FeatureTrack* track;
  std::array<double, 3> enu_m;
};

// The tracks that fit the poses, the longest first, until every frame has `a_frame` of them.
std::vector<TriangulatedTrack> tracks_that_fit(const std::vector<FeatureTrack>& tracks,
                                               const std::vector<CameraPose>& poses,
                                               const Pinhole& camera, double max_rms_px,
                                               std::size_t a_frame) {
  std::vector<std::size_t> order(tracks.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return tracks[a].size() > tracks[b].size();
  });
  std::vector<std::size_t> taken_of_frame(poses.size(), 0);
  std::vector<TriangulatedTrack> taken;
  for (const std::size_t i : order) {
    const FeatureTrack& track = tracks[i];
    const bool wanted =
        std::any_of(track.begin(), track.end(), [&](const PixelObservation& observation) {
          return taken_of_frame[observation.frame] < a_frame;
        });
    if (!wanted) continue;
    const auto placed = triangulate(track, poses, camera, 1);
    if (!placed || placed->rms_px > max_rms_px) continue;
    if ((placed->enu_m - poses[track.front().frame].enu_m).norm() > kFarthestM) continue;
    for (const PixelObservation& observation : track) ++taken_of_frame[observation.frame];
    taken.push_back({&track, {placed->enu_m.x(), placed->enu_m.y(), placed->enu_m.z()}});
  }
  return taken;
}

// How far recorded positions are from the adjusted ones, on each axis.
double position_spread_m(const std::vector<CameraPose>& poses,
                         const std::vector<PoseBlock>& recorded, std::size_t final_frames) {
  double squares = 0;
  for (std::size_t i = final_frames; i < poses.size(); ++i)
    squares +=
        (poses[i].enu_m - Eigen::Map<const Eigen::Vector3d>(recorded[i].data())).squaredNorm();
  return std::sqrt(squares / (3.0 * static_cast<double>(poses.size() - final_frames)));
}

void solve(std::vector<PoseBlock>& blocks, const std::vector<PoseBlock>& recorded,
           std::size_t final_frames, std::vector<TriangulatedTrack>& tracks, const Pinhole& camera,
           const AdjustmentSettings& settings) {
  ceres::Problem problem;
  double mounting_yaw = 0;
  ceres::LossFunction* loss = new ceres::CauchyLoss(2);  // owned by the problem once used
  bool loss_used = false;
  auto* ordering = new ceres::ParameterBlockOrdering;
  for (TriangulatedTrack& track : tracks) {
    for (const PixelObservation& observation : *track.track) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ImageError, 2, 6, 3>(new ImageError{
                                   observation.pixel, camera, settings.pixel_sigma_px}),
                               loss, blocks[observation.frame].data(), track.enu_m.data());
      loss_used = true;
    }
    ordering->AddElementToGroup(track.enu_m.data(), 0);
  }
  if (!loss_used) delete loss;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    problem.AddParameterBlock(blocks[i].data(), 6);
    if (i < final_frames) {  // no prior: its final heading includes the mounting
      problem.SetParameterBlockConstant(blocks[i].data());
    } else {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<RecordError, 6, 6, 1>(
                                   new RecordError{recorded[i], settings}),
                               nullptr, blocks[i].data(), &mounting_yaw);
    }
    ordering->AddElementToGroup(blocks[i].data(), 1);
  }
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MountingError, 1, 1>(
                               new MountingError{settings.mounting_sigma_deg * kRadPerDeg}),
                           nullptr, &mounting_yaw);
  ordering->AddElementToGroup(&mounting_yaw, 1);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering.reset(ordering);
  options.max_num_iterations = 15;
  options.function_tolerance = 1e-4;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

}  // namespace

void adjust_poses(std::vector<CameraPose>& poses, std::size_t final_frames,
                  const std::vector<FeatureTrack>& tracks, const Pinhole& camera,
                  const AdjustmentSettings& settings) {
  AdjustmentSettings used = settings;
  std::vector<PoseBlock> recorded;
  recorded.reserve(poses.size());
  for (const CameraPose& pose : poses) recorded.push_back(block_from(pose));
  for (const double max_rms_px : {settings.max_first_rms_px, settings.max_rms_px}) {
    std::vector<TriangulatedTrack> fitting =
        tracks_that_fit(tracks, poses, camera, max_rms_px, settings.tracks_a_frame);
    std::vector<PoseBlock> blocks;
    blocks.reserve(poses.size());
    for (const CameraPose& pose : poses) blocks.push_back(block_from(pose));
    solve(blocks, recorded, final_frames, fitting, camera, used);
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = pose_from(blocks[i].data());
    if (final_frames == poses.size()) continue;
    used.position_sigma_m = std::clamp(position_spread_m(poses, recorded, final_frames),
                                       settings.least_position_sigma_m, settings.position_sigma_m);
  }
}

}  // namespace milepost
