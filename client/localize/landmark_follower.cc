#include "client/localize/landmark_follower.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "client/estimation/student_t.h"
#include "client/localize/pose_consensus.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr int kSearchLooks = 3;  // for each landmark in its place, each from a better pose
constexpr double kMaxOriginDistanceM = 300;  // then the tangent frame is laid anew
constexpr double kProjectionReachM = 40;     // beyond what was driven since the last sight

}  // namespace

Followed LandmarkFollower::begin(SeenFrame& frame, double along_m,
                                 const std::optional<LearnedCamera>& camera) {
  timestamp_s_ = frame.timestamp_s();
  last_along_m_ = along_m;
  belief_ = first_belief(along_m);
  if (camera) {
    belief_.mean.segment<3>(kLogFocal) = camera->mean;
    belief_.covariance.block<3, 3>(kLogFocal, kLogFocal) = camera->covariance;
  }
  Followed followed;
  const AlongRange region = AlongRange{along_m, along_m}.widened(method_.start_region_m);
  followed.failure = window_.cover(frame.held(), region).failure;
  const CompactFrame& compact = search_.compact(frame);
  if (const auto estimate = searched(compact, belief_, region)) {
    const PlaceSupport support = support_of(*estimate, compact);
    followed.log_bayes_factor = log_bayes_factor(support);
    take(*estimate, support, compact, followed);
  }
  return followed;
}

void LandmarkFollower::observe(const Odometry& odometry) {
  belief_ = with_wheels(expected(odometry.timestamp_s), odometry.speed_mps,
                        odometry.yaw_rate_dps * kRadPerDeg, method_.wheels);
  timestamp_s_ = std::max(timestamp_s_, odometry.timestamp_s);
}

TrackedPosition LandmarkFollower::position_at(double timestamp_s) const {
  return tracked(expected(timestamp_s));
}

Followed LandmarkFollower::follow(SeenFrame& frame) {
  Followed followed;
  lay_origin_near();
  const PoseBelief before = tilted(expected(frame.timestamp_s()), method_.motion);
  timestamp_s_ = frame.timestamp_s();
  belief_ = before;
  const AlongRange region = region_about(before);
  const Covered covered = window_.cover(frame.held(), region);
  followed.failure = covered.failure;
  measure(search_.compact(frame), before, region, followed);
  // Landmarks that are not here yet speak against nothing.
  if (!covered.complete && !followed.measured) followed.log_bayes_factor = 0;
  return followed;
}

AlongRange LandmarkFollower::needed(double timestamp_s) const {
  return region_about(tilted(expected(timestamp_s), method_.motion));
}

AlongRange LandmarkFollower::region_about(const PoseBelief& belief) const {
  const Placed at = placed(belief);
  const double reach_m = method_.region_sigmas * at.along_sigma_m + method_.min_region_m;
  return AlongRange{at.along_m, at.along_m}.widened(reach_m);
}

// Judges what the frame says before the belief takes it in.
void LandmarkFollower::measure(const CompactFrame& frame, const PoseBelief& before,
                               const AlongRange& region, Followed& followed) {
  const bool is_near = placed(before).along_sigma_m < method_.max_expected_sigma_m;
  auto estimate = is_near ? expected_to_be(frame, before, region) : std::nullopt;
  const bool is_searched = !estimate;
  if (is_searched) estimate = searched(frame, widened(before), region);
  const PlaceSupport support = support_of(estimate.value_or(PoseEstimate{before, {}}), frame);
  followed.log_bayes_factor = log_bayes_factor(support);
  if (estimate) followed.log_bayes_factor += log_density_of_leap(before, estimate->belief);
  const double least =
      std::max(is_searched ? method_.min_searched_log_bayes_factor : method_.min_log_bayes_factor,
               method_.min_usual_part * usual_log_bayes_factor_);
  if (estimate && followed.log_bayes_factor >= least) {
    take(*estimate, support, frame, followed);
  } else if (static_cast<int>(frame.features.size()) >= method_.min_seeing_features) {
    followed.log_bayes_factor =
        std::min(followed.log_bayes_factor, method_.log_bayes_factor_of_nothing);
  }
}

TrackedPosition LandmarkFollower::position() const { return tracked(belief_); }

std::optional<LearnedCamera> LandmarkFollower::learned_camera() const {
  return LearnedCamera{belief_.mean.segment<3>(kLogFocal),
                       belief_.covariance.block<3, 3>(kLogFocal, kLogFocal)};
}

TrackedPosition LandmarkFollower::tracked(const PoseBelief& belief) const {
  const Placed at = placed(belief);
  const double inside_m = std::max(0.0, std::min(at.along_m, line_.length_m() - at.along_m));
  const double factor = std::sqrt(1 + method_.missed_variance * missed_part_ * missed_part_ +
                                  method_.end_variance * std::exp(-inside_m / method_.end_reach_m));
  return {at.along_m, factor * at.along_sigma_m,
          Across{at.lateral_m, factor * at.lateral_sigma_m, camera_of(belief, factor)}};
}

// `sigma_factor`: by which sigmas are told wider than the belief's.
CameraPlacement LandmarkFollower::camera_of(const PoseBelief& belief, double sigma_factor) const {
  using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  Matrix6 covariance = belief.covariance.topLeftCorner<6, 6>();
  covariance.diagonal().head<3>().array() += method_.min_sigma_m * method_.min_sigma_m;
  covariance *= sigma_factor * sigma_factor;
  covariance.rightCols<3>() /= kRadPerDeg;
  covariance.bottomRows<3>() /= kRadPerDeg;
  CameraPlacement camera{position_of(belief), wrapped_360(belief.mean[kHeading] / kRadPerDeg),
                         belief.mean[kPitch] / kRadPerDeg, belief.mean[kRoll] / kRadPerDeg};
  Eigen::Map<Matrix6>(camera.covariance.data()) = covariance;
  return camera;
}

// Each landmark searched where it is expected, twice: the second time from a better pose.
std::optional<PoseEstimate> LandmarkFollower::expected_to_be(const CompactFrame& frame,
                                                             const PoseBelief& before,
                                                             const AlongRange& region) const {
  const PoseSolver solver(search_.camera.pinhole, frame.features, window_.landmarks(),
                          method_.solver);
  PoseEstimate estimate{before, {}};
  for (int look = 0; look < 2; ++look) {
    const auto matches =
        match_expected(frame, search_.layer->parameters().codebook->step(), window_.landmarks(),
                       region, estimate.belief, search_.camera.pinhole, method_.match);
    estimate = solver.estimate(before, estimate.belief.mean, matches);
    const auto agreeing = static_cast<double>(estimate.agreeing.size());
    if (agreeing < method_.min_support) return std::nullopt;
    if (agreeing < method_.min_agreeing_part * static_cast<double>(matches.size()))
      return std::nullopt;
  }
  return estimate;
}

// Landmarks searched in the whole frame, a pose that they agree on, and then each in its place.
std::optional<PoseEstimate> LandmarkFollower::searched(const CompactFrame& frame,
                                                       const PoseBelief& before,
                                                       const AlongRange& region) const {
  const auto matches = match_anywhere(frame, search_.layer->parameters().codebook->step(),
                                      window_.landmarks(), region, method_.match);
  const PoseSolver solver(search_.camera.pinhole, frame.features, window_.landmarks(),
                          method_.solver);
  const auto agreed = estimate_by_consensus(solver, before, matches, method_.consensus);
  if (!agreed || static_cast<int>(agreed->agreeing.size()) < search_.min_start_support)
    return std::nullopt;
  PoseEstimate estimate = *agreed;
  for (int look = 0; look < kSearchLooks; ++look) {
    const auto again =
        match_expected(frame, search_.layer->parameters().codebook->step(), window_.landmarks(),
                       region, estimate.belief, search_.camera.pinhole, method_.match);
    estimate = solver.estimate(before, estimate.belief.mean, again);
    if (static_cast<int>(estimate.agreeing.size()) < search_.min_start_support) return std::nullopt;
  }
  return estimate;
}

PlaceSupport LandmarkFollower::support_of(const PoseEstimate& estimate,
                                          const CompactFrame& frame) const {
  const PoseSolver solver(search_.camera.pinhole, frame.features, window_.landmarks(),
                          method_.solver);
  const double along_m = std::clamp(placed(estimate.belief).along_m, 0.0, line_.length_m());
  return milepost::support_of(estimate, along_m, frame, window_.landmarks(), solver, search_.camera,
                              method_.match);
}

// How unlikely it is that the vehicle is where a frame puts it and not where it was expected, by
// Student's t over the plan; up to kUsualSigmas nothing speaks against it.
double LandmarkFollower::log_density_of_leap(const PoseBelief& before,
                                             const PoseBelief& found) const {
  constexpr double kDegrees = 3;
  constexpr double kUsualSigmas = 2;
  const Eigen::Vector2d leap_m = found.mean.head<2>() - before.mean.head<2>();
  const Eigen::Matrix2d covariance = before.covariance.topLeftCorner<2, 2>();
  const double squared_sigmas = leap_m.dot(covariance.ldlt().solve(leap_m));
  return std::min(0.0, log_student_t(squared_sigmas, kDegrees) -
                           log_student_t(kUsualSigmas * kUsualSigmas, kDegrees));
}

PoseBelief LandmarkFollower::first_belief(double along_m) const {
  PoseBelief belief;
  const EnuPoint at = window_.frame().enu_from_geo(line_.point_at(along_m));
  const double heading_rad = line_.heading_deg_at(along_m) * kRadPerDeg;
  belief.mean.head<4>() << at.east_m, at.north_m, at.up_m, heading_rad;
  belief.mean[kSpeed] = method_.start_speed_mps;
  const Eigen::Vector2d ahead(std::sin(heading_rad), std::cos(heading_rad));
  const Eigen::Vector2d right(ahead.y(), -ahead.x());
  const auto squared = [](double sigma) { return sigma * sigma; };
  StateMatrix& covariance = belief.covariance;
  covariance.block<2, 2>(kEast, kEast) =
      squared(method_.start_along_sigma_m) * ahead * ahead.transpose() +
      squared(method_.start_lateral_sigma_m) * right * right.transpose();
  covariance(kUp, kUp) = squared(method_.start_up_sigma_m);
  covariance(kHeading, kHeading) = squared(method_.start_heading_sigma_deg * kRadPerDeg);
  covariance(kPitch, kPitch) = covariance(kRoll, kRoll) =
      squared(method_.start_tilt_sigma_deg * kRadPerDeg);
  covariance(kLogFocal, kLogFocal) = squared(method_.focal_sigma);
  covariance(kPrincipalX, kPrincipalX) = covariance(kPrincipalY, kPrincipalY) =
      squared(method_.principal_sigma);
  covariance(kSpeed, kSpeed) = squared(method_.start_speed_sigma_mps);
  covariance(kYawRate, kYawRate) = squared(method_.start_yaw_rate_sigma);
  covariance(kMounting, kMounting) = squared(method_.mounting_sigma_deg * kRadPerDeg);
  covariance(kWheelScale, kWheelScale) = squared(method_.wheel_scale_sigma);
  covariance(kYawRateBias, kYawRateBias) = squared(method_.yaw_rate_bias_sigma);
  return belief;
}

// What a search that begins anew takes for granted: less than the belief.
PoseBelief LandmarkFollower::widened(const PoseBelief& belief) const {
  PoseBelief wide = belief;
  wide.covariance *= method_.search_widening * method_.search_widening;
  return wide;
}

PoseBelief LandmarkFollower::expected(double timestamp_s) const {
  const double along_m = placed(belief_).along_m;
  constexpr double kSlopeReachM = 3;
  const AlongRange reach = {std::max(0.0, along_m - kSlopeReachM),
                            std::min(line_.length_m(), along_m + kSlopeReachM)};
  const double slope =
      reach.to_m > reach.from_m
          ? (line_.point_at(reach.to_m).altitude_m - line_.point_at(reach.from_m).altitude_m) /
                (reach.to_m - reach.from_m)
          : 0;
  return predicted(belief_, std::max(0.0, timestamp_s - timestamp_s_), slope, method_.motion);
}

GeoPoint LandmarkFollower::position_of(const PoseBelief& belief) const {
  return window_.frame().geo_from_enu({belief.mean[kEast], belief.mean[kNorth], belief.mean[kUp]});
}

LandmarkFollower::Placed LandmarkFollower::placed(const PoseBelief& belief) const {
  const GeoPoint position = position_of(belief);
  const double reach_m =
      kProjectionReachM + geodesic_distance_m(line_.point_at(last_along_m_), position);
  const AlongRange near = {std::max(0.0, last_along_m_ - reach_m),
                           std::min(line_.length_m(), last_along_m_ + reach_m)};
  const LineProjection beside = line_.project(position, near);
  const double heading_rad = line_.heading_deg_at(beside.along_m) * kRadPerDeg;
  const Eigen::Vector2d ahead(std::sin(heading_rad), std::cos(heading_rad));
  const Eigen::Vector2d right(ahead.y(), -ahead.x());
  const EnuPoint foot = window_.frame().enu_from_geo(line_.point_at(beside.along_m));
  const Eigen::Vector2d off =
      belief.mean.segment<2>(kEast) - Eigen::Vector2d(foot.east_m, foot.north_m);
  const Eigen::Matrix2d covariance = belief.covariance.topLeftCorner<2, 2>();
  Placed at{beside.along_m, beside.lateral_m, 0, 0};
  const bool at_end = beside.along_m <= 0 || beside.along_m >= line_.length_m();
  if (at_end) at.along_m += off.dot(ahead);
  if (at_end) at.lateral_m = off.dot(right);
  at.along_sigma_m = std::hypot(std::sqrt(ahead.dot(covariance * ahead)), method_.min_sigma_m);
  at.lateral_sigma_m = std::hypot(std::sqrt(right.dot(covariance * right)), method_.min_sigma_m);
  return at;
}

void LandmarkFollower::take(const PoseEstimate& estimate, const PlaceSupport& support,
                            const CompactFrame& frame, Followed& followed) {
  belief_ = estimate.belief;
  last_along_m_ = placed(belief_).along_m;
  missed_part_ = support.expected > 0 ? 1 - support.found / support.expected : 1;
  constexpr double kOfLate = 0.1;  // the weight of the latest frame
  usual_log_bayes_factor_ += kOfLate * (log_bayes_factor(support) - usual_log_bayes_factor_);
  followed.measured = true;
  followed.matches = static_cast<int>(estimate.agreeing.size());
  tell(estimate, frame);
}

void LandmarkFollower::lay_origin_near() {
  if (belief_.mean.head<2>().norm() < kMaxOriginDistanceM) return;
  const GeoPoint position = position_of(belief_);
  window_.set_origin(line_.point_at(last_along_m_));
  const EnuPoint at = window_.frame().enu_from_geo(position);
  belief_.mean.head<3>() << at.east_m, at.north_m, at.up_m;
}

void LandmarkFollower::tell(const PoseEstimate& estimate, const CompactFrame& frame) const {
  if (!search_.on_estimate) return;
  const auto estimates =
      along_by_scale(estimate.agreeing, frame.features, window_.landmarks(), search_.camera.pinhole,
                     line_, window_.frame(), method_.solver.scale_sigma);
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const LandmarkMatch& match = estimate.agreeing[i];
    search_.on_estimate({estimates[i], frame.features[match.feature].scale_px,
                         window_.landmarks()[match.landmark].along, 1});
  }
}

}  // namespace milepost
