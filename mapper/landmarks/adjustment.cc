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

// Standard deviations of recorded poses.
struct RecordSigmas {
  double plan_m = 0;  // east and north
  double up_m = 0;
  double heading_rad = 0;
  double tilt_rad = 0;  // pitch and roll
};

// Deviation of a pose from the recorded one.
struct RecordError {
  PoseBlock recorded;
  RecordSigmas sigmas;

  template <class Scalar>
  bool operator()(const Scalar* pose, const Scalar* mounting_yaw, Scalar* residual) const {
    for (int i = 0; i < 2; ++i) residual[i] = (pose[i] - recorded[i]) / sigmas.plan_m;
    residual[2] = (pose[2] - recorded[2]) / sigmas.up_m;
    residual[3] = (pose[3] - recorded[3] - *mounting_yaw) / sigmas.heading_rad;
    for (int i = 4; i < 6; ++i) residual[i] = (pose[i] - recorded[i]) / sigmas.tilt_rad;
    return true;
  }
};

RecordSigmas sigmas_of(const AdjustmentSettings& settings) {
  return {settings.position_sigma_m, settings.position_sigma_m,
          settings.heading_sigma_deg * kRadPerDeg, settings.tilt_sigma_deg * kRadPerDeg};
}

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
  double rms_px;
};

struct FittingTracks {
  std::vector<TriangulatedTrack> tracks;
  std::vector<const FeatureTrack*> unfit;  // that could be triangulated, too

  double share() const {
    const std::size_t placed = tracks.size() + unfit.size();
    return placed == 0 ? 1 : static_cast<double>(tracks.size()) / static_cast<double>(placed);
  }
};

// The tracks that fit the poses, the longest first, until every frame has `a_frame` of them.
FittingTracks tracks_that_fit(const std::vector<FeatureTrack>& tracks,
                              const std::vector<CameraPose>& poses, const Pinhole& camera,
                              double max_rms_px, std::size_t a_frame) {
  std::vector<std::size_t> order(tracks.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return tracks[a].size() > tracks[b].size();
  });
  std::vector<std::size_t> taken_of_frame(poses.size(), 0);
  FittingTracks taken;
  for (const std::size_t i : order) {
    const FeatureTrack& track = tracks[i];
    const bool wanted =
        std::any_of(track.begin(), track.end(), [&](const PixelObservation& observation) {
          return taken_of_frame[observation.frame] < a_frame;
        });
    if (!wanted) continue;
    const auto placed = triangulate(track, poses, camera, 1);
    if (!placed) continue;
    if ((placed->enu_m - poses[track.front().frame].enu_m).norm() > kFarthestM) continue;
    if (placed->rms_px > max_rms_px) {
      taken.unfit.push_back(&track);
      continue;
    }
    for (const PixelObservation& observation : track) ++taken_of_frame[observation.frame];
    taken.tracks.push_back(
        {&track, {placed->enu_m.x(), placed->enu_m.y(), placed->enu_m.z()}, placed->rms_px});
  }
  return taken;
}

// How far an adjusted pose is from the recorded one, the mounting's yaw aside.
PoseBlock off_record(const CameraPose& pose, const PoseBlock& recorded, double mounting_yaw) {
  PoseBlock off = block_from(pose);
  for (std::size_t axis = 0; axis < off.size(); ++axis) off[axis] -= recorded[axis];
  off[3] -= mounting_yaw;
  return off;
}

// The mean square, on each axis, of how far recorded poses are from the adjusted ones.
PoseBlock mean_squares_off(const std::vector<CameraPose>& poses,
                           const std::vector<PoseBlock>& recorded, std::size_t final_frames,
                           double mounting_yaw) {
  PoseBlock squares{};
  for (std::size_t i = final_frames; i < poses.size(); ++i) {
    const PoseBlock off = off_record(poses[i], recorded[i], mounting_yaw);
    for (std::size_t axis = 0; axis < off.size(); ++axis)
      squares[axis] += off[axis] * off[axis] / static_cast<double>(poses.size() - final_frames);
  }
  return squares;
}

// What is believed of recorded poses next. A moderate contradiction changes nothing, for tracks
// alone distort the road where it turns.
RecordSigmas believed_sigmas(const PoseBlock& squares, const AdjustmentSettings& settings) {
  const RecordSigmas first = sigmas_of(settings);
  const auto unless_contradicted = [&](double usual, double first_sigma, double square,
                                       double greatest) {
    const double spread = std::sqrt(square);
    return spread > settings.contradicted_sigmas * first_sigma ? std::min(spread, greatest) : usual;
  };
  // All axes tell how exact the positions are.
  const double position_m = std::clamp(std::sqrt((squares[0] + squares[1] + squares[2]) / 3),
                                       settings.least_position_sigma_m, settings.position_sigma_m);
  RecordSigmas believed = first;
  believed.plan_m = unless_contradicted(position_m, first.plan_m, (squares[0] + squares[1]) / 2,
                                        settings.greatest_position_sigma_m);
  believed.up_m =
      unless_contradicted(position_m, first.up_m, squares[2], settings.greatest_position_sigma_m);
  believed.heading_rad = unless_contradicted(first.heading_rad, first.heading_rad, squares[3],
                                             settings.greatest_heading_sigma_deg * kRadPerDeg);
  return believed;
}

// Returns the camera's yaw against the recorded headings.
double solve(std::vector<PoseBlock>& blocks, const std::vector<PoseBlock>& recorded,
             std::size_t final_frames, std::vector<TriangulatedTrack>& tracks,
             const Pinhole& camera, const RecordSigmas& sigmas, double pixel_sigma_px,
             const AdjustmentSettings& settings) {
  ceres::Problem problem;
  double mounting_yaw = 0;
  ceres::LossFunction* loss = new ceres::CauchyLoss(2);  // owned by the problem once used
  bool loss_used = false;
  auto* ordering = new ceres::ParameterBlockOrdering;
  for (TriangulatedTrack& track : tracks) {
    for (const PixelObservation& observation : *track.track) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ImageError, 2, 6, 3>(new ImageError{
              observation.pixel, camera, pixel_sigma_px * observation.magnification}),
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
                                   new RecordError{recorded[i], sigmas}),
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
  return mounting_yaw;
}

// Whether recorded poses are much worse than was thought.
bool exceeds(const RecordSigmas& found, const RecordSigmas& thought) {
  constexpr double kMuch = 1.5;
  return found.plan_m > kMuch * thought.plan_m || found.up_m > kMuch * thought.up_m ||
         found.heading_rad > kMuch * thought.heading_rad;
}

class Adjustment {
 public:
  Adjustment(std::vector<CameraPose>& poses, std::size_t final_frames,
             const std::vector<FeatureTrack>& tracks, const Pinhole& camera,
             const AdjustmentSettings& settings)
      : poses_(poses),
        final_frames_(final_frames),
        tracks_(tracks),
        camera_(camera),
        settings_(settings),
        believed_(sigmas_of(settings)) {
    recorded_.reserve(poses.size());
    for (const CameraPose& pose : poses) recorded_.push_back(block_from(pose));
  }

  void run() {
    FittingTracks fitting = fitting_within(settings_.max_first_rms_px);
    if (fitting.share() < settings_.least_fitting) {
      start_roughly();
      fitting = fitting_within(settings_.max_first_rms_px);
    }
    for (int pass = 1;; ++pass) {
      const RecordSigmas thought = believed_;
      solve_with(fitting.tracks, thought, settings_.pixel_sigma_px);
      const bool is_settled = pass + 1 >= settings_.max_passes || !exceeds(believed_, thought);
      if (is_settled) break;
      fitting = fitting_within(settings_.max_first_rms_px);
    }
    solve_with(fitting_within(settings_.max_rms_px).tracks, believed_, settings_.pixel_sigma_px);
  }

  // Of each frame beyond the constant ones.
  std::vector<ImageWitness> witness() const {
    std::vector<ImageWitness> of_frame(poses_.size() - final_frames_);
    for (std::size_t i = final_frames_; i < poses_.size(); ++i) {
      const PoseBlock off = off_record(poses_[i], recorded_[i], mounting_yaw_);
      ImageWitness& witness = of_frame[i - final_frames_];
      witness.frames = 1;
      witness.plan_m2 = off[0] * off[0] + off[1] * off[1];
      witness.up_m2 = off[2] * off[2];
      witness.heading_deg2 = off[3] * off[3] * kDegPerRad * kDegPerRad;
    }
    const auto of_middle = [&](const FeatureTrack& track) -> ImageWitness* {
      const std::size_t middle = track[track.size() / 2].frame;
      return middle < final_frames_ ? nullptr : &of_frame[middle - final_frames_];
    };
    const FittingTracks fitting = fitting_within(settings_.max_rms_px);
    for (const TriangulatedTrack& track : fitting.tracks) {
      ImageWitness* witness = of_middle(*track.track);
      if (witness == nullptr) continue;
      ++witness->tracks;
      ++witness->fitting;
      witness->observations += track.track->size();
      witness->reprojection_px2 +=
          track.rms_px * track.rms_px * static_cast<double>(track.track->size());
    }
    for (const FeatureTrack* track : fitting.unfit)
      if (ImageWitness* witness = of_middle(*track)) ++witness->tracks;
    return of_frame;
  }

 private:
  FittingTracks fitting_within(double max_rms_px) const {
    return tracks_that_fit(tracks_, poses_, camera_, max_rms_px, settings_.tracks_a_frame);
  }

  // Where most tracks contradict the record, it is not known yet which part of it is wrong: large
  // errors are allowed first, of poses and of pixels.
  void start_roughly() {
    const RecordSigmas rough = {settings_.rough_position_sigma_m, settings_.rough_position_sigma_m,
                                settings_.rough_heading_sigma_deg * kRadPerDeg,
                                settings_.tilt_sigma_deg * kRadPerDeg};
    for (const double scale : {16, 4}) {
      solve_with(fitting_within(scale * settings_.max_first_rms_px).tracks, rough,
                 scale * settings_.pixel_sigma_px);
    }
    believed_ = sigmas_of(settings_);  // what was allowed says nothing of the record
  }

  // Moves the poses, and finds out what to believe of the recorded ones.
  void solve_with(std::vector<TriangulatedTrack> fitting, const RecordSigmas& sigmas,
                  double pixel_sigma_px) {
    std::vector<PoseBlock> blocks;
    blocks.reserve(poses_.size());
    for (const CameraPose& pose : poses_) blocks.push_back(block_from(pose));
    mounting_yaw_ = solve(blocks, recorded_, final_frames_, fitting, camera_, sigmas,
                          pixel_sigma_px, settings_);
    for (std::size_t i = 0; i < poses_.size(); ++i) poses_[i] = pose_from(blocks[i].data());
    if (final_frames_ == poses_.size()) return;
    believed_ = believed_sigmas(mean_squares_off(poses_, recorded_, final_frames_, mounting_yaw_),
                                settings_);
  }

  std::vector<CameraPose>& poses_;
  std::size_t final_frames_;
  const std::vector<FeatureTrack>& tracks_;
  const Pinhole& camera_;
  const AdjustmentSettings& settings_;
  std::vector<PoseBlock> recorded_;
  RecordSigmas believed_;
  double mounting_yaw_ = 0;
};

}  // namespace

std::vector<ImageWitness> adjust_poses(std::vector<CameraPose>& poses, std::size_t final_frames,
                                       const std::vector<FeatureTrack>& tracks,
                                       const Pinhole& camera, const AdjustmentSettings& settings) {
  Adjustment adjustment(poses, final_frames, tracks, camera, settings);
  adjustment.run();
  return adjustment.witness();
}

}  // namespace milepost
