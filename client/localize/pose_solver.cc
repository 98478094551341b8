#include "client/localize/pose_solver.h"

#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace milepost {
namespace {

constexpr double kNearestM = 0.5;
constexpr int kPoseStates = kPrincipalY + 1;  // that the image depends on

using PoseRow = Eigen::Matrix<double, 1, kPoseStates>;

double cauchy_weight(double sigmas, double width) { return 1 / (1 + std::pow(sigmas / width, 2)); }

double biweight(double sigmas, double cutoff) {
  const double inside = std::max(0.0, 1 - std::pow(sigmas / cutoff, 2));
  return inside * inside;
}

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

// A match seen from a pose.
struct PoseSolver::Linearized {
  Eigen::Vector2d residual_px;
  Eigen::Matrix<double, 2, kPoseStates> pixel_by_pose;
  Eigen::Matrix2d pixel_information;
  double residual_log_scale = 0;
  PoseRow log_scale_by_pose;
  double scale_information = 0;
  double pixel_sigmas = 0;
  double scale_sigmas = 0;
};

bool PoseSolver::linearize(const StateVector& state, const LandmarkMatch& match,
                           Linearized& at) const {
  const PoseBelief here{state, {}};
  const CameraPose pose = here.pose();
  const Pinhole camera = here.camera(camera_);
  const PlacedLandmark& landmark = landmarks_[match.landmark];
  const Feature& feature = features_[match.feature];
  const Eigen::Matrix3d level = level_camera_from_enu(pose.heading_rad);
  const Eigen::Matrix3d pitched = pitched_from_level(pose.pitch_rad);
  const Eigen::Matrix3d rolled = rolled_from_pitched(pose.roll_rad);
  const Eigen::Matrix3d rotation = rolled * pitched * level;
  const Eigen::Vector3d from_camera = landmark.enu_m - pose.enu_m;
  const Eigen::Vector3d seen = rotation * from_camera;
  if (!(seen.z() > kNearestM)) return false;

  Eigen::Matrix<double, 3, kPoseStates> seen_by_pose =
      Eigen::Matrix<double, 3, kPoseStates>::Zero();
  seen_by_pose.leftCols<3>() = -rotation;
  seen_by_pose.col(kHeading) = rolled * pitched * level_by_heading(pose.heading_rad) * from_camera;
  seen_by_pose.col(kPitch) = rolled * pitched_by_pitch(pose.pitch_rad) * level * from_camera;
  seen_by_pose.col(kRoll) = rolled_by_roll(pose.roll_rad) * pitched * level * from_camera;
  Eigen::Matrix<double, 2, 3> pixel_by_seen;
  const double z = seen.z();
  pixel_by_seen << camera.focal_x_px / z, 0, -camera.focal_x_px * seen.x() / (z * z), 0,
      camera.focal_y_px / z, -camera.focal_y_px * seen.y() / (z * z);

  at.residual_px = Eigen::Vector2d(feature.x_px, feature.y_px) - camera.pixel_of(seen);
  at.pixel_by_pose = pixel_by_seen * seen_by_pose;
  at.pixel_by_pose.col(kLogFocal) << camera.focal_x_px * seen.x() / z,
      camera.focal_y_px * seen.y() / z;
  at.pixel_by_pose(0, kPrincipalX) = camera_.focal_x_px;
  at.pixel_by_pose(1, kPrincipalY) = camera_.focal_y_px;
  const Eigen::Matrix<double, 2, 3> pixel_by_landmark = pixel_by_seen * rotation;
  const Eigen::Vector2d along_ray = pixel_by_landmark * landmark.mapping_ray;
  const double pixel_sigma =
      std::hypot(settings_.pixel_sigma_px, settings_.pixel_per_scale * feature.scale_px);
  const Eigen::Matrix2d pixel_covariance =
      Eigen::Matrix2d::Identity() * pixel_sigma * pixel_sigma +
      along_ray * along_ray.transpose() * landmark.depth_sigma_m * landmark.depth_sigma_m +
      pixel_by_landmark * pixel_by_landmark.transpose() * settings_.landmark_sigma_m *
          settings_.landmark_sigma_m;
  at.pixel_information = pixel_covariance.inverse();
  at.pixel_sigmas = std::sqrt(at.residual_px.dot(at.pixel_information * at.residual_px));

  at.residual_log_scale =
      std::log(feature.scale_px) - std::log(landmark.size_m * camera.focal_px() / z);
  at.log_scale_by_pose = -seen_by_pose.row(2) / z;
  at.log_scale_by_pose[kLogFocal] = 1;
  const double depth_sigma = landmark.depth_sigma_m / z;
  const double scale_variance = settings_.scale_sigma * settings_.scale_sigma +
                                landmark.size_sigma * landmark.size_sigma +
                                depth_sigma * depth_sigma;
  at.scale_information = 1 / scale_variance;
  at.scale_sigmas = std::abs(at.residual_log_scale) / std::sqrt(scale_variance);
  return true;
}

// One step of Gauss and Newton. Whether it could be made.
template <class Weight>
bool PoseSolver::step(const PoseBelief& before, const StateMatrix& before_information,
                      const std::vector<LandmarkMatch>& matches, const Weight& weight,
                      StateVector& state, StateMatrix& information) const {
  information = before_information;
  StateVector gradient = before_information * (before.mean - state);
  Linearized at;
  for (const LandmarkMatch& match : matches) {
    if (!linearize(state, match, at)) continue;
    const double of_pixel = weight(at.pixel_sigmas);
    if (of_pixel <= 0) continue;
    const Eigen::Matrix<double, kPoseStates, 2> weighed =
        of_pixel * at.pixel_by_pose.transpose() * at.pixel_information;
    information.topLeftCorner<kPoseStates, kPoseStates>() += weighed * at.pixel_by_pose;
    gradient.head<kPoseStates>() += weighed * at.residual_px;
    const double of_scale =
        of_pixel * cauchy_weight(at.scale_sigmas, settings_.cauchy) * at.scale_information;
    information.topLeftCorner<kPoseStates, kPoseStates>() +=
        of_scale * at.log_scale_by_pose.transpose() * at.log_scale_by_pose;
    gradient.head<kPoseStates>() +=
        of_scale * at.log_scale_by_pose.transpose() * at.residual_log_scale;
  }
  const StateVector change = information.ldlt().solve(gradient);
  if (!change.allFinite()) return false;
  state += change;
  return true;
}

PoseEstimate PoseSolver::estimate(const PoseBelief& before, const StateVector& initial,
                                  const std::vector<LandmarkMatch>& matches) const {
  const StateMatrix before_information = before.covariance.inverse();
  StateVector state = initial;
  StateMatrix information = before_information;
  const auto gently = [&](double sigmas) { return cauchy_weight(sigmas, settings_.cauchy); };
  const auto strictly = [&](double sigmas) { return biweight(sigmas, settings_.cutoff); };
  for (int i = 0; i < settings_.iterations; ++i) {
    if (!step(before, before_information, matches, gently, state, information)) break;
  }
  for (int i = 0; i < settings_.iterations; ++i) {
    if (!step(before, before_information, matches, strictly, state, information)) break;
  }
  PoseEstimate estimate;
  estimate.belief.mean = state;
  estimate.belief.covariance = information.inverse();
  for (const LandmarkMatch& match : matches) {
    if (pixel_sigmas(state, match) < settings_.cutoff) {
      estimate.agreeing.push_back(match);
    }
  }
  return estimate;
}

StateVector PoseSolver::hypothesis(const PoseBelief& before,
                                   const std::vector<LandmarkMatch>& matches) const {
  constexpr int kIterations = 4;
  const StateMatrix before_information = before.covariance.inverse();
  StateVector state = before.mean;
  StateMatrix information;
  for (int i = 0; i < kIterations; ++i) {
    if (!step(
            before, before_information, matches, [](double) { return 1.0; }, state, information))
      break;
  }
  return state;
}

double PoseSolver::pixel_sigmas(const StateVector& state, const LandmarkMatch& match) const {
  Linearized at;
  return linearize(state, match, at) ? at.pixel_sigmas : std::numeric_limits<double>::infinity();
}

}  // namespace milepost
