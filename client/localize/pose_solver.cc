#include "client/localize/pose_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

#include "client/estimation/robust_weights.h"

namespace milepost {
namespace {

constexpr int kPoseStates = kPrincipalY + 1;  // states that the image depends on

using PoseRow = Eigen::Matrix<double, 1, kPoseStates>;

// Derivatives of the factors of camera_from_enu by their angles.
Eigen::Matrix3d level_by_heading(double heading_rad) {
  Eigen::Matrix3d m;
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  m << -s, -c, 0, 0, 0, 0, c, -s, 0;
  return m;
}

Eigen::Matrix3d pitched_by_pitch(double pitch_rad) {
  Eigen::Matrix3d m;
  const double c = std::cos(pitch_rad);
  const double s = std::sin(pitch_rad);
  m << 0, 0, 0, 0, -s, c, 0, -c, -s;
  return m;
}

Eigen::Matrix3d rolled_by_roll(double roll_rad) {
  Eigen::Matrix3d m;
  const double c = std::cos(roll_rad);
  const double s = std::sin(roll_rad);
  m << -s, c, 0, -c, -s, 0, 0, 0, 0;
  return m;
}

}  // namespace

// A state with the rotations and derivatives shared by all matches.
struct PoseSolver::View {
  View(const StateVector& state, const Pinhole& given)
      : pose(PoseBelief{state, {}}.pose()),
        camera(PoseBelief{state, {}}.camera(given)),
        level(level_camera_from_enu(pose.heading_rad)),
        pitched(pitched_from_level(pose.pitch_rad)),
        rolled(rolled_from_pitched(pose.roll_rad)),
        rotation(rolled * pitched * level),
        by_heading(rolled * pitched * level_by_heading(pose.heading_rad)),
        by_pitch(rolled * pitched_by_pitch(pose.pitch_rad) * level),
        by_roll(rolled_by_roll(pose.roll_rad) * pitched * level) {}

  CameraPose pose;
  Pinhole camera;
  Eigen::Matrix3d level, pitched, rolled;
  Eigen::Matrix3d rotation;                       // camera_from_enu, and its derivatives ...
  Eigen::Matrix3d by_heading, by_pitch, by_roll;  // ... by the angles
};

// A match with its residuals at a state.
struct PoseSolver::Seen {
  Eigen::Vector3d from_camera_m;  // from the camera to the landmark, in the tangent frame ...
  Eigen::Vector3d seen_m;         // ... and in the camera frame
  Eigen::Matrix<double, 2, 3> pixel_by_seen;
  Eigen::Vector2d residual_px;
  Eigen::Matrix2d pixel_information;
  double pixel_sigmas = 0;
};

// The Jacobians of its residuals by the pose.
struct PoseSolver::Linearized {
  Eigen::Matrix<double, 2, kPoseStates> pixel_by_pose;
  double residual_log_scale = 0;
  PoseRow log_scale_by_pose;
  double scale_information = 0;
  double scale_sigmas = 0;
};

// Returns whether the landmark lies in front of the camera.
bool PoseSolver::look(const View& view, const LandmarkMatch& match, Seen& at) const {
  const LocalLandmark& landmark = landmarks_[match.landmark];
  const Feature& feature = features_[match.feature];
  at.from_camera_m = landmark.enu_m - view.pose.enu_m;
  at.seen_m = view.rotation * at.from_camera_m;
  if (!(at.seen_m.z() > kNearestSeenM)) return false;
  at.pixel_by_seen = view.camera.projection_jacobian(at.seen_m);
  at.residual_px = Eigen::Vector2d(feature.x_px, feature.y_px) - view.camera.project(at.seen_m);
  const Eigen::Matrix<double, 2, 3> pixel_by_landmark = at.pixel_by_seen * view.rotation;
  const Eigen::Vector2d along_ray = pixel_by_landmark * landmark.mapping_ray;
  const double pixel_sigma = std::hypot(settings_.pixel_sigma_px * feature.magnification,
                                        settings_.pixel_per_scale * feature.scale_px);
  const Eigen::Matrix2d pixel_covariance =
      Eigen::Matrix2d::Identity() * pixel_sigma * pixel_sigma +
      along_ray * along_ray.transpose() * landmark.depth_sigma_m * landmark.depth_sigma_m +
      pixel_by_landmark * pixel_by_landmark.transpose() * settings_.landmark_sigma_m *
          settings_.landmark_sigma_m;
  at.pixel_information = pixel_covariance.inverse();
  at.pixel_sigmas = std::sqrt(at.residual_px.dot(at.pixel_information * at.residual_px));
  return true;
}

void PoseSolver::linearize(const View& view, const LandmarkMatch& match, const Seen& seen,
                           Linearized& at) const {
  const LocalLandmark& landmark = landmarks_[match.landmark];
  const double z = seen.seen_m.z();
  Eigen::Matrix<double, 3, kPoseStates> seen_by_pose =
      Eigen::Matrix<double, 3, kPoseStates>::Zero();
  seen_by_pose.leftCols<3>() = -view.rotation;
  seen_by_pose.col(kHeading) = view.by_heading * seen.from_camera_m;
  seen_by_pose.col(kPitch) = view.by_pitch * seen.from_camera_m;
  seen_by_pose.col(kRoll) = view.by_roll * seen.from_camera_m;
  at.pixel_by_pose = seen.pixel_by_seen * seen_by_pose;
  at.pixel_by_pose.col(kLogFocal) << view.camera.focal_x_px * seen.seen_m.x() / z,
      view.camera.focal_y_px * seen.seen_m.y() / z;
  at.pixel_by_pose(0, kPrincipalX) = camera_.focal_x_px;
  at.pixel_by_pose(1, kPrincipalY) = camera_.focal_y_px;

  at.residual_log_scale = std::log(features_[match.feature].scale_px) -
                          std::log(landmark.size_m * view.camera.focal_px() / z);
  at.log_scale_by_pose = -seen_by_pose.row(2) / z;
  at.log_scale_by_pose[kLogFocal] = 1;
  const double depth_sigma = landmark.depth_sigma_m / z;
  const double scale_variance = settings_.scale_sigma * settings_.scale_sigma +
                                landmark.size_sigma * landmark.size_sigma +
                                depth_sigma * depth_sigma;
  at.scale_information = 1 / scale_variance;
  at.scale_sigmas = std::abs(at.residual_log_scale) / std::sqrt(scale_variance);
}

// One Gauss-Newton step. Returns whether it succeeded.
template <class Weight>
bool PoseSolver::step(const PoseBelief& before, const StateMatrix& before_information,
                      const std::vector<LandmarkMatch>& matches, const Weight& weight,
                      StateVector& state, StateMatrix& information) const {
  information = before_information;
  StateVector gradient = before_information * (before.x - state);
  const View view(state, camera_);
  // The scale error shared by all features of a frame is a state that is marginalized.
  double shared_information = 1 / (settings_.shared_scale_sigma * settings_.shared_scale_sigma);
  Eigen::Matrix<double, kPoseStates, 1> shared_by_pose =
      Eigen::Matrix<double, kPoseStates, 1>::Zero();
  double shared_gradient = 0;
  Seen seen;
  Linearized at;
  for (const LandmarkMatch& match : matches) {
    if (!look(view, match, seen)) continue;
    const double of_pixel = weight(seen.pixel_sigmas);
    if (of_pixel <= 0) continue;
    linearize(view, match, seen, at);
    const Eigen::Matrix<double, kPoseStates, 2> weighed =
        of_pixel * at.pixel_by_pose.transpose() * seen.pixel_information;
    information.topLeftCorner<kPoseStates, kPoseStates>() += weighed * at.pixel_by_pose;
    gradient.head<kPoseStates>() += weighed * seen.residual_px;
    const double of_scale =
        of_pixel * cauchy_weight(at.scale_sigmas, settings_.cauchy) * at.scale_information;
    information.topLeftCorner<kPoseStates, kPoseStates>() +=
        of_scale * at.log_scale_by_pose.transpose() * at.log_scale_by_pose;
    gradient.head<kPoseStates>() +=
        of_scale * at.log_scale_by_pose.transpose() * at.residual_log_scale;
    shared_information += of_scale;
    shared_by_pose += of_scale * at.log_scale_by_pose.transpose();
    shared_gradient += of_scale * at.residual_log_scale;
  }
  information.topLeftCorner<kPoseStates, kPoseStates>() -=
      shared_by_pose * shared_by_pose.transpose() / shared_information;
  gradient.head<kPoseStates>() -= shared_by_pose * shared_gradient / shared_information;
  const StateVector change = information.ldlt().solve(gradient);
  if (!change.allFinite()) return false;
  state += change;
  return true;
}

// By the median of the inliers' residuals: of two coordinates their length has a Rayleigh
// distribution.
double PoseSolver::biweight_cutoff(const StateVector& state,
                                   const std::vector<LandmarkMatch>& matches) const {
  const double median_of_rayleigh = std::sqrt(2 * std::numbers::ln2);
  std::vector<double> inliers = pixel_sigmas(state, matches);
  std::erase_if(inliers, [&](double sigmas) { return sigmas >= settings_.cutoff; });
  if (inliers.empty()) return settings_.cutoff;
  const auto middle = inliers.begin() + static_cast<std::ptrdiff_t>(inliers.size() / 2);
  std::ranges::nth_element(inliers, middle);
  return std::clamp(settings_.biweight_deviations * *middle / median_of_rayleigh,
                    settings_.min_biweight_cutoff, settings_.cutoff);
}

PoseEstimate PoseSolver::estimate(const PoseBelief& before, const StateVector& initial,
                                  const std::vector<LandmarkMatch>& matches) const {
  const StateMatrix before_information = before.P.inverse();
  StateVector state = initial;
  StateMatrix information = before_information;
  const auto gently = [&](double sigmas) { return cauchy_weight(sigmas, settings_.cauchy); };
  for (int i = 0; i < settings_.iterations; ++i) {
    if (!step(before, before_information, matches, gently, state, information)) break;
  }
  const double cutoff = biweight_cutoff(state, matches);
  const auto strictly = [&](double sigmas) { return biweight(sigmas, cutoff); };
  for (int i = 0; i < settings_.iterations; ++i) {
    if (!step(before, before_information, matches, strictly, state, information)) break;
  }
  PoseEstimate estimate;
  estimate.belief.x = state;
  estimate.belief.P = information.inverse();
  const std::vector<double> sigmas = pixel_sigmas(state, matches);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (sigmas[i] < settings_.cutoff) estimate.agreeing.push_back(matches[i]);
  }
  return estimate;
}

StateVector PoseSolver::hypothesis(const PoseBelief& before, const StateMatrix& before_information,
                                   const std::vector<LandmarkMatch>& matches) const {
  constexpr int kIterations = 4;
  StateVector state = before.x;
  StateMatrix information;
  for (int i = 0; i < kIterations; ++i) {
    if (!step(
            before, before_information, matches, [](double) { return 1.0; }, state, information))
      break;
  }
  return state;
}

std::vector<double> PoseSolver::pixel_sigmas(const StateVector& state,
                                             const std::vector<LandmarkMatch>& matches) const {
  const View view(state, camera_);
  std::vector<double> sigmas;
  sigmas.reserve(matches.size());
  Seen seen;
  for (const LandmarkMatch& match : matches) {
    sigmas.push_back(look(view, match, seen) ? seen.pixel_sigmas
                                             : std::numeric_limits<double>::infinity());
  }
  return sigmas;
}

}  // namespace milepost
