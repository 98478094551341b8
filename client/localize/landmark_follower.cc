#include <algorithm>
#include <cmath>

#include "client/localize/follower.h"
#include "client/localize/landmark_matching.h"
#include "client/localize/pose_consensus.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kMaxOriginDistanceM = 300;  // then the tangent frame is laid anew
constexpr double kProjectionReachM = 40;     // beyond what was driven since the last sight

// A belief about the pose as one about along and across the line.
struct Placed {
  double along_m = 0;  // beyond the line's ends, too
  double lateral_m = 0;
  double along_sigma_m = 0;
  double lateral_sigma_m = 0;
};

class LandmarkFollower : public Follower {
 public:
  LandmarkFollower(const SegmentSession& session, const QueryCamera& camera,
                   const LocalizerSettings& settings, const LandmarkMethod& method)
      : line_(session.line),
        feature_(session.feature),
        codebook_(*session.codebook),
        camera_{camera.focal_x_px, camera.focal_y_px, camera.principal_x_px, camera.principal_y_px},
        min_start_support_(settings.min_start_support),
        on_estimate_(settings.on_estimate),
        method_(method),
        window_(session.layer, settings.window.reach, session.line) {}

  Result<std::optional<Sighting>> find(const QueryFrame& frame, const AlongRange& around) override {
    const Status covered = window_.cover(around);
    if (!covered.ok()) return covered.error();
    const CompactFrame compact(frame.features(feature_), codebook_);
    const std::vector<LandmarkMatch> matches =
        match_anywhere(compact, codebook_.step(), window_.landmarks(), around, method_.match);
    const auto seen = combine_robustly(by_scale(matches, compact), method_.vote);
    if (!seen || seen->support < min_start_support_) return std::optional<Sighting>();
    return std::optional(Sighting{*seen, static_cast<double>(seen->support), around});
  }

  Result<int> start(const QueryFrame& frame, const Sighting& sighting) override {
    timestamp_s_ = frame.timestamp_s;
    last_along_m_ = sighting.measurement.along_m;
    window_.set_origin(line_.point_at(last_along_m_));
    belief_ = first_belief(last_along_m_);
    const AlongRange region =
        AlongRange{last_along_m_, last_along_m_}.widened(method_.start_along_sigma_m);
    const Status covered = window_.cover(region);
    if (!covered.ok()) return covered.error();
    const CompactFrame compact(frame.features(feature_), codebook_);
    const auto estimate = searched(compact, belief_, region);
    if (!estimate) return 0;
    take(*estimate);
    return static_cast<int>(estimate->agreeing.size());
  }

  void observe(const Odometry& odometry) override {
    belief_ = with_wheels(expected(odometry.timestamp_s), odometry.speed_mps,
                          odometry.yaw_rate_dps * kRadPerDeg, method_.wheels);
    timestamp_s_ = std::max(timestamp_s_, odometry.timestamp_s);
  }

  double expected_along_m(double timestamp_s) const override {
    return placed(expected(timestamp_s)).along_m;
  }

  Followed follow(const QueryFrame& frame) override {
    Followed followed;
    lay_origin_near();
    const PoseBelief before = tilted(expected(frame.timestamp_s), method_.motion);
    timestamp_s_ = frame.timestamp_s;
    const Placed at = placed(before);
    const double reach_m = method_.region_sigmas * at.along_sigma_m + method_.min_region_m;
    const AlongRange region = AlongRange{at.along_m, at.along_m}.widened(reach_m);
    const Status covered = window_.cover(region);
    if (!covered.ok()) {
      followed.failure = covered.error();
      belief_ = before;
      return followed;
    }
    const CompactFrame compact(frame.features(feature_), codebook_);
    std::optional<PoseEstimate> estimate;
    if (at.along_sigma_m < method_.max_expected_sigma_m)
      estimate = expected_to_be(compact, before, region);
    if (!estimate) estimate = searched(compact, widened(before), region);
    if (!estimate) {
      belief_ = before;
      return followed;
    }
    take(*estimate);
    tell(*estimate, compact);
    followed.measured = true;
    followed.matches = static_cast<int>(estimate->agreeing.size());
    return followed;
  }

  TrackedPosition position() const override {
    const Placed at = placed(belief_);
    return {at.along_m, at.along_sigma_m,
            Across{at.lateral_m, at.lateral_sigma_m,
                   wrapped_360(belief_.mean[kHeading] / kRadPerDeg), position_of(belief_)}};
  }

 private:
  // Each landmark searched where it is expected, twice: the second time from a better pose.
  std::optional<PoseEstimate> expected_to_be(const CompactFrame& frame, const PoseBelief& before,
                                             const AlongRange& region) const {
    const PoseSolver solver(camera_, frame.features, window_.landmarks(), method_.solver);
    PoseEstimate estimate{before, {}};
    for (int look = 0; look < 2; ++look) {
      const auto matches = match_expected(frame, codebook_.step(), window_.landmarks(), region,
                                          estimate.belief, camera_, method_.match);
      estimate = solver.estimate(before, estimate.belief.mean, matches);
      const auto agreeing = static_cast<double>(estimate.agreeing.size());
      if (agreeing < method_.min_support) return std::nullopt;
      if (agreeing < method_.min_agreeing_part * static_cast<double>(matches.size()))
        return std::nullopt;
    }
    return estimate;
  }

  // Landmarks searched in the whole frame, a pose that they agree on, and then each in its place.
  std::optional<PoseEstimate> searched(const CompactFrame& frame, const PoseBelief& before,
                                       const AlongRange& region) const {
    const auto matches =
        match_anywhere(frame, codebook_.step(), window_.landmarks(), region, method_.match);
    const PoseSolver solver(camera_, frame.features, window_.landmarks(), method_.solver);
    const auto agreed = estimate_by_consensus(solver, before, matches, method_.consensus);
    if (!agreed || static_cast<int>(agreed->agreeing.size()) < min_start_support_)
      return std::nullopt;
    const auto again = match_expected(frame, codebook_.step(), window_.landmarks(), region,
                                      agreed->belief, camera_, method_.match);
    PoseEstimate estimate = solver.estimate(before, agreed->belief.mean, again);
    if (static_cast<int>(estimate.agreeing.size()) < min_start_support_) return std::nullopt;
    return estimate;
  }

  PoseBelief first_belief(double along_m) const {
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
  PoseBelief widened(const PoseBelief& belief) const {
    PoseBelief wide = belief;
    wide.covariance *= method_.search_widening * method_.search_widening;
    return wide;
  }

  PoseBelief expected(double timestamp_s) const {
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

  GeoPoint position_of(const PoseBelief& belief) const {
    return window_.frame().geo_from_enu(
        {belief.mean[kEast], belief.mean[kNorth], belief.mean[kUp]});
  }

  Placed placed(const PoseBelief& belief) const {
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

  void take(const PoseEstimate& estimate) {
    belief_ = estimate.belief;
    last_along_m_ = placed(belief_).along_m;
  }

  void lay_origin_near() {
    if (belief_.mean.head<2>().norm() < kMaxOriginDistanceM) return;
    const GeoPoint position = position_of(belief_);
    window_.set_origin(line_.point_at(last_along_m_));
    const EnuPoint at = window_.frame().enu_from_geo(position);
    belief_.mean.head<3>() << at.east_m, at.north_m, at.up_m;
  }

  std::vector<PositionEstimate> by_scale(const std::vector<LandmarkMatch>& matches,
                                         const CompactFrame& frame) const {
    return along_by_scale(matches, frame.features, window_.landmarks(), camera_, line_,
                          window_.frame(), method_.solver.scale_sigma);
  }

  void tell(const PoseEstimate& estimate, const CompactFrame& frame) const {
    if (!on_estimate_) return;
    const auto estimates = by_scale(estimate.agreeing, frame);
    for (std::size_t i = 0; i < estimates.size(); ++i) {
      const LandmarkMatch& match = estimate.agreeing[i];
      on_estimate_({estimates[i], frame.features[match.feature].scale_px,
                    window_.landmarks()[match.landmark].along, 1});
    }
  }

  const RouteLine& line_;
  FeatureParameters feature_;
  const Codebook& codebook_;
  Pinhole camera_;
  int min_start_support_;
  std::function<void(const TrackletEstimate&)> on_estimate_;
  LandmarkMethod method_;
  LandmarkWindow window_;
  PoseBelief belief_;       // in the window's frame
  double timestamp_s_ = 0;  // of the belief
  double last_along_m_ = 0;
};

}  // namespace

std::unique_ptr<Follower> make_landmark_follower(const SegmentSession& session,
                                                 const QueryCamera& camera,
                                                 const LocalizerSettings& settings,
                                                 const LandmarkMethod& method) {
  return std::make_unique<LandmarkFollower>(session, camera, settings, method);
}

}  // namespace milepost
