#include "client/localize/landmark_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "client/estimation/student_t.h"
#include "client/localize/pose_consensus.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Of guided matching after a consensus, each from a better pose.
constexpr int kRelocalizationIterations = 3;
constexpr double kMaxOriginDistanceM = 300;  // beyond it the tangent frame is recentered
constexpr double kProjectionReachM = 40;     // beyond the distance since the last measurement

}  // namespace

TrackingResult LandmarkTracker::begin(SharedFrame& frame, double along_m,
                                      const std::optional<LearnedCamera>& camera) {
  timestamp_s_ = frame.timestamp_s();
  last_along_m_ = along_m;
  belief_ = first_belief(along_m);
  if (camera) {
    belief_.x.segment<3>(kLogFocal) = camera->mean;
    belief_.P.block<3, 3>(kLogFocal, kLogFocal) = camera->covariance;
  }
  TrackingResult result;
  const AlongRange region = AlongRange{along_m, along_m}.widened(method().start_region_m);
  result.failure = cover(frame.held(), region).failure;
  const CompactFrame& compact = compact_frame(frame, *layer_);
  if (const auto estimate = relocalize(compact, belief_, region)) {
    const LandmarkSupport support = support_of(*estimate, compact);
    result.log_bayes_factor = log_bayes_factor(support);
    accept(*estimate, support, compact, result);
  }
  return result;
}

void LandmarkTracker::observe(const Odometry& odometry) {
  belief_ = odometry_update(predicted_to(odometry.timestamp_s), odometry.speed_mps,
                            odometry.yaw_rate_dps * kRadPerDeg, method().odometry);
  timestamp_s_ = std::max(timestamp_s_, odometry.timestamp_s);
}

TrackedPose LandmarkTracker::pose_at(double timestamp_s) const {
  return tracked_pose(predicted_to(timestamp_s));
}

TrackingResult LandmarkTracker::track(SharedFrame& frame) {
  TrackingResult result;
  recenter_frame();
  const PoseBelief before = add_tilt_noise(predicted_to(frame.timestamp_s()), method().motion);
  timestamp_s_ = frame.timestamp_s();
  belief_ = before;
  follow_road(frame.held(), belief_);
  const AlongRange region = region_about(before);
  const Covered covered = cover(frame.held(), region);
  result.failure = covered.failure;
  measure(compact_frame(frame, *layer_), before, region, result);
  follow_road(frame.held(), belief_);
  // Tiles that have not arrived are no contradiction.
  if (!covered.complete && !result.measured) result.log_bayes_factor = 0;
  return result;
}

Covered LandmarkTracker::cover(const HeldMap& held, const AlongRange& region) {
  const auto road = road_around(held, layer_, region, search_->reach);
  mapped_ = road.front().extent();
  for (const UnrolledSegment& segment : road) mapped_ = mapped_.joined(segment.extent());
  return window_.cover(held, road, region);
}

// Moves on to the successor, or back to the predecessor, that fits the belief best, and to another
// branch of a junction that fits better.
void LandmarkTracker::follow_road(const HeldMap& held, const PoseBelief& belief) {
  constexpr int kMaxJunctions = 8;   // passed within one frame
  constexpr double kBackM = 0.5;     // before the begin of a segment, until it is left ...
  constexpr double kBetterM = 1;     // ... and by which another branch fits better
  constexpr double kBranchesM = 60;  // from a junction up to which its branches are compared
  for (int passed = 0; passed < kMaxJunctions; ++passed) {
    const double along_m = frenet_of(belief).along_m;
    const auto road = unrolled_road(held, layer_, {along_m - kBranchesM, along_m + kBranchesM});
    const bool is_beyond = along_m > line().length_m();
    const bool is_before = along_m < -kBackM;
    const UnrolledSegment* best = nullptr;
    double least_m = is_beyond || is_before ? std::numeric_limits<double>::infinity()
                                            : mismatch_m(road.front(), belief, along_m) - kBetterM;
    for (const UnrolledSegment& segment : road) {
      const bool is_candidate =
          is_beyond   ? segment.side == RoadSide::ahead && segment.junctions == 1
          : is_before ? segment.side == RoadSide::behind && segment.junctions == 1
                      : segment.side == RoadSide::beside && segment.extent().contains(along_m);
      if (!is_candidate) continue;
      const double fit_m = mismatch_m(segment, belief, along_m);
      if (fit_m >= least_m) continue;
      least_m = fit_m;
      best = &segment;
    }
    if (best == nullptr) return;
    move_to(*best);
  }
}

void LandmarkTracker::move_to(const UnrolledSegment& segment) {
  layer_ = segment.layer;
  mapped_ = mapped_.shifted(-segment.offset_m);
  last_along_m_ = std::clamp(last_along_m_ - segment.offset_m, 0.0, line().length_m());
}

// How badly a segment near `along_m` of the current one's way fits a belief: the distance in space,
// and that between the headings.
double LandmarkTracker::mismatch_m(const UnrolledSegment& segment, const PoseBelief& belief,
                                   double along_m) const {
  constexpr double kNearM = 15;
  constexpr double kMetresPerRadian = 6;
  const RouteLine& there = segment.layer->line;
  const GeoPoint position = position_of(belief);
  const double middle_m = std::clamp(along_m - segment.offset_m, 0.0, there.length_m());
  const LineProjection beside = there.project(
      position, {std::max(0.0, middle_m - kNearM), std::min(there.length_m(), middle_m + kNearM)});
  const double course_deg = (belief.x[kHeading] - belief.x[kMounting]) / kRadPerDeg;
  const double turn_rad =
      std::abs(turn_deg(there.heading_deg_at(beside.along_m), course_deg)) * kRadPerDeg;
  const double climb_m = position.altitude_m - there.point_at(beside.along_m).altitude_m;
  return std::hypot(beside.distance_m, climb_m) + kMetresPerRadian * turn_rad;
}

AlongRange LandmarkTracker::needed(double timestamp_s) const {
  return region_about(add_tilt_noise(predicted_to(timestamp_s), method().motion));
}

AlongRange LandmarkTracker::region_about(const PoseBelief& belief) const {
  const FrenetPosition at = frenet_of(belief);
  const double reach_m = method().region_sigmas * at.along_sigma_m + method().min_region_m;
  return AlongRange{at.along_m, at.along_m}.widened(reach_m);
}

// Tests the measurement of a frame before the belief is updated with it.
void LandmarkTracker::measure(const CompactFrame& frame, const PoseBelief& before,
                              const AlongRange& region, TrackingResult& result) {
  const bool is_near = frenet_of(before).along_sigma_m < method().max_guided_sigma_m;
  auto estimate = is_near ? track_landmarks(frame, before, region) : std::nullopt;
  const bool is_relocalized = !estimate;
  if (is_relocalized) estimate = relocalize(frame, widened(before), region);
  const LandmarkSupport support = support_of(estimate.value_or(PoseEstimate{before, {}}), frame);
  result.log_bayes_factor = log_bayes_factor(support);
  if (estimate) result.log_bayes_factor += log_density_of_jump(before, estimate->belief);
  const double least = std::max(
      is_relocalized ? method().min_relocalized_log_bayes_factor : method().min_log_bayes_factor,
      method().min_usual_part * usual_log_bayes_factor_);
  if (estimate && result.log_bayes_factor >= least) {
    accept(*estimate, support, frame, result);
  } else if (static_cast<int>(frame.features.size()) >= method().min_seeing_features) {
    result.contradicted = true;
    if (!estimate)
      result.log_bayes_factor =
          std::min(result.log_bayes_factor, method().log_bayes_factor_of_nothing);
  }
}

TrackedPose LandmarkTracker::pose() const { return tracked_pose(belief_); }

std::optional<LearnedCamera> LandmarkTracker::learned_camera() const {
  return LearnedCamera{belief_.x.segment<3>(kLogFocal),
                       belief_.P.block<3, 3>(kLogFocal, kLogFocal)};
}

TrackedPose LandmarkTracker::tracked_pose(const PoseBelief& belief) const {
  const FrenetPosition at = frenet_of(belief);
  const double inside_m =
      std::max(0.0, std::min(at.along_m - mapped_.from_m, mapped_.to_m - at.along_m));
  const double factor =
      std::sqrt(1 + method().missed_variance * missed_part_ * missed_part_ +
                method().end_variance * std::exp(-inside_m / method().end_reach_m));
  return {at.along_m, factor * at.along_sigma_m,
          FullPose{at.lateral_m, factor * at.lateral_sigma_m, camera_pose_of(belief, factor)}};
}

// `sigma_factor`: factor of the reported sigmas over the belief's.
GeoCameraPose LandmarkTracker::camera_pose_of(const PoseBelief& belief, double sigma_factor) const {
  using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  Matrix6 covariance = belief.P.topLeftCorner<6, 6>();
  covariance.diagonal().head<3>().array() += method().min_sigma_m * method().min_sigma_m;
  covariance *= sigma_factor * sigma_factor;
  covariance.rightCols<3>() /= kRadPerDeg;
  covariance.bottomRows<3>() /= kRadPerDeg;
  GeoCameraPose camera{position_of(belief), wrapped_360(belief.x[kHeading] / kRadPerDeg),
                       belief.x[kPitch] / kRadPerDeg, belief.x[kRoll] / kRadPerDeg};
  Eigen::Map<Matrix6>(camera.covariance.data()) = covariance;
  return camera;
}

// Two rounds of guided matching; the second starts from a better pose.
std::optional<PoseEstimate> LandmarkTracker::track_landmarks(const CompactFrame& frame,
                                                             const PoseBelief& before,
                                                             const AlongRange& region) const {
  const PoseSolver solver(search_->camera.pinhole, frame.features, window_.landmarks(),
                          method().solver);
  PoseEstimate estimate{before, {}};
  for (int iteration = 0; iteration < 2; ++iteration) {
    const auto matches = match_guided(frame, quantization_step(), window_.landmarks(), region,
                                      estimate.belief, search_->camera.pinhole, method().match);
    estimate = solver.estimate(before, estimate.belief.x, matches);
    const auto agreeing = static_cast<double>(estimate.agreeing.size());
    if (agreeing < method().min_support) return std::nullopt;
    if (agreeing < method().min_agreeing_part * static_cast<double>(matches.size()))
      return std::nullopt;
  }
  return estimate;
}

// Global matching, a consensus pose, and then guided matching from there.
std::optional<PoseEstimate> LandmarkTracker::relocalize(const CompactFrame& frame,
                                                        const PoseBelief& before,
                                                        const AlongRange& region) const {
  const auto matches =
      match_global(frame, quantization_step(), window_.landmarks(), region, method().match);
  const PoseSolver solver(search_->camera.pinhole, frame.features, window_.landmarks(),
                          method().solver);
  const auto agreed = estimate_by_consensus(solver, before, matches, method().consensus);
  if (!agreed || static_cast<int>(agreed->agreeing.size()) < search_->min_start_support)
    return std::nullopt;
  PoseEstimate estimate = *agreed;
  for (int iteration = 0; iteration < kRelocalizationIterations; ++iteration) {
    const auto again = match_guided(frame, quantization_step(), window_.landmarks(), region,
                                    estimate.belief, search_->camera.pinhole, method().match);
    estimate = solver.estimate(before, estimate.belief.x, again);
    if (static_cast<int>(estimate.agreeing.size()) < search_->min_start_support)
      return std::nullopt;
  }
  return estimate;
}

LandmarkSupport LandmarkTracker::support_of(const PoseEstimate& estimate,
                                            const CompactFrame& frame) const {
  const PoseSolver solver(search_->camera.pinhole, frame.features, window_.landmarks(),
                          method().solver);
  const double along_m = std::clamp(frenet_of(estimate.belief).along_m, 0.0, line().length_m());
  return milepost::support_of(estimate, along_m, frame, window_.landmarks(), solver,
                              search_->camera, method().match);
}

// The log-density of a jump from the predicted to the measured position, by a bivariate Student's t
// in the plane, relative to that at kUsualSigmas; never above 0.
double LandmarkTracker::log_density_of_jump(const PoseBelief& before,
                                            const PoseBelief& found) const {
  constexpr double kDegrees = 3;
  constexpr double kUsualSigmas = 2;
  const Eigen::Vector2d jump_m = found.x.head<2>() - before.x.head<2>();
  const Eigen::Matrix2d covariance = before.P.topLeftCorner<2, 2>();
  const double squared_sigmas = jump_m.dot(covariance.ldlt().solve(jump_m));
  return std::min(0.0, log_student_t(squared_sigmas, kDegrees) -
                           log_student_t(kUsualSigmas * kUsualSigmas, kDegrees));
}

PoseBelief LandmarkTracker::first_belief(double along_m) const {
  PoseBelief belief;
  const EnuPoint at = window_.frame().enu_from_geo(line().point_at(along_m));
  const double heading_rad = line().heading_deg_at(along_m) * kRadPerDeg;
  const Mounting& mounting = search_->camera.mounting;
  const double mounting_rad = mounting.yaw_deg * kRadPerDeg;
  belief.x.head<4>() << at.east_m, at.north_m, at.up_m, heading_rad + mounting_rad;
  belief.x[kPitch] = mounting.pitch_deg * kRadPerDeg;
  belief.x[kRoll] = mounting.roll_deg * kRadPerDeg;
  belief.x[kMounting] = mounting_rad;
  belief.x[kSpeed] = method().start_speed_mps;
  const Eigen::Vector2d ahead(std::sin(heading_rad), std::cos(heading_rad));
  const Eigen::Vector2d right(ahead.y(), -ahead.x());
  const auto squared = [](double sigma) { return sigma * sigma; };
  StateMatrix& covariance = belief.P;
  covariance.block<2, 2>(kEast, kEast) =
      squared(method().start_along_sigma_m) * ahead * ahead.transpose() +
      squared(method().start_lateral_sigma_m) * right * right.transpose();
  covariance(kUp, kUp) = squared(method().start_up_sigma_m);
  covariance(kHeading, kHeading) = squared(method().start_heading_sigma_deg * kRadPerDeg);
  covariance(kPitch, kPitch) = covariance(kRoll, kRoll) =
      squared(method().start_tilt_sigma_deg * kRadPerDeg);
  covariance(kLogFocal, kLogFocal) = squared(method().focal_sigma);
  covariance(kPrincipalX, kPrincipalX) = covariance(kPrincipalY, kPrincipalY) =
      squared(method().principal_sigma);
  covariance(kSpeed, kSpeed) = squared(method().start_speed_sigma_mps);
  covariance(kYawRate, kYawRate) = squared(method().start_yaw_rate_sigma);
  covariance(kMounting, kMounting) = squared(method().mounting_sigma_deg * kRadPerDeg);
  covariance(kOdometryScale, kOdometryScale) = squared(method().odometry_scale_sigma);
  covariance(kYawRateBias, kYawRateBias) = squared(method().yaw_rate_bias_sigma);
  return belief;
}

// The prior of a relocalization: wider than the belief.
PoseBelief LandmarkTracker::widened(const PoseBelief& belief) const {
  PoseBelief wide = belief;
  wide.P *= method().relocalization_widening * method().relocalization_widening;
  return wide;
}

PoseBelief LandmarkTracker::predicted_to(double timestamp_s) const {
  const double along_m = frenet_of(belief_).along_m;
  constexpr double kSlopeReachM = 3;
  const AlongRange reach = {std::max(0.0, along_m - kSlopeReachM),
                            std::min(line().length_m(), along_m + kSlopeReachM)};
  const double slope =
      reach.to_m > reach.from_m
          ? (line().point_at(reach.to_m).altitude_m - line().point_at(reach.from_m).altitude_m) /
                (reach.to_m - reach.from_m)
          : 0;
  const Mounting& mounting = search_->camera.mounting;
  return predict(belief_, std::max(0.0, timestamp_s - timestamp_s_), slope, method().motion,
                 {mounting.forward_m, mounting.right_m});
}

GeoPoint LandmarkTracker::position_of(const PoseBelief& belief) const {
  return window_.frame().geo_from_enu({belief.x[kEast], belief.x[kNorth], belief.x[kUp]});
}

LandmarkTracker::FrenetPosition LandmarkTracker::frenet_of(const PoseBelief& belief) const {
  const GeoPoint position = position_of(belief);
  const double reach_m =
      kProjectionReachM + geodesic_distance_m(line().point_at(last_along_m_), position);
  const AlongRange near = {std::max(0.0, last_along_m_ - reach_m),
                           std::min(line().length_m(), last_along_m_ + reach_m)};
  const LineProjection beside = line().project(position, near);
  const double heading_rad = line().heading_deg_at(beside.along_m) * kRadPerDeg;
  const Eigen::Vector2d ahead(std::sin(heading_rad), std::cos(heading_rad));
  const Eigen::Vector2d right(ahead.y(), -ahead.x());
  const EnuPoint foot = window_.frame().enu_from_geo(line().point_at(beside.along_m));
  const Eigen::Vector2d off =
      belief.x.segment<2>(kEast) - Eigen::Vector2d(foot.east_m, foot.north_m);
  const Eigen::Matrix2d covariance = belief.P.topLeftCorner<2, 2>();
  FrenetPosition at{beside.along_m, beside.lateral_m, 0, 0};
  const bool at_end = beside.along_m <= 0 || beside.along_m >= line().length_m();
  if (at_end) at.along_m += off.dot(ahead);
  if (at_end) at.lateral_m = off.dot(right);
  at.along_sigma_m = std::hypot(std::sqrt(ahead.dot(covariance * ahead)), method().min_sigma_m);
  at.lateral_sigma_m = std::hypot(std::sqrt(right.dot(covariance * right)), method().min_sigma_m);
  return at;
}

void LandmarkTracker::accept(const PoseEstimate& estimate, const LandmarkSupport& support,
                             const CompactFrame& frame, TrackingResult& result) {
  belief_ = estimate.belief;
  last_along_m_ = frenet_of(belief_).along_m;
  missed_part_ = support.expected > 0 ? 1 - support.found / support.expected : 1;
  constexpr double kRate = 0.1;  // of the exponential moving average
  usual_log_bayes_factor_ += kRate * (log_bayes_factor(support) - usual_log_bayes_factor_);
  result.measured = true;
  result.matches = static_cast<int>(estimate.agreeing.size());
  report_estimates(estimate, frame);
}

void LandmarkTracker::recenter_frame() {
  if (belief_.x.head<2>().norm() < kMaxOriginDistanceM) return;
  const GeoPoint position = position_of(belief_);
  window_.set_origin(line().point_at(last_along_m_));
  const EnuPoint at = window_.frame().enu_from_geo(position);
  belief_.x.head<3>() << at.east_m, at.north_m, at.up_m;
}

void LandmarkTracker::report_estimates(const PoseEstimate& estimate,
                                       const CompactFrame& frame) const {
  if (!search_->on_estimate) return;
  const auto estimates = along_by_scale(estimate.agreeing, frame.features, window_.landmarks(),
                                        search_->camera.pinhole, method().solver.scale_sigma);
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const LandmarkMatch& match = estimate.agreeing[i];
    search_->on_estimate({estimates[i], frame.features[match.feature].scale_px,
                          window_.landmarks()[match.landmark].along, 1});
  }
}

}  // namespace milepost
