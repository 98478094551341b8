#include "client/localize/hypothesis.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include <Eigen/Dense>

#include "client/estimation/student_t.h"

namespace milepost {
namespace {

constexpr double kMinLogOdds = -4;  // below which a hypothesis is dropped
// Part of the best pose's matches from which another pose is an alternative.
constexpr double kAlternativePart = 0.6;

// Whether two hypotheses are the same position.
bool is_same(const Hypothesis& a, const Hypothesis& b) {
  return a.layer().key == b.layer().key &&
         std::abs(a.tracker->pose().along_m - b.tracker->pose().along_m) < kSameHypothesisM;
}

// Merges equal hypotheses: keeps the pose with the most inliers, the highest odds and the highest
// log Bayes factor of the frame.
void merge_same(std::vector<Hypothesis>& hypotheses) {
  std::ranges::stable_sort(hypotheses, std::greater<>(), &Hypothesis::matches);
  std::vector<Hypothesis> merged;
  for (Hypothesis& hypothesis : hypotheses) {
    const auto same = std::ranges::find_if(
        merged, [&](const Hypothesis& other) { return is_same(hypothesis, other); });
    if (same == merged.end()) {
      merged.push_back(std::move(hypothesis));
      continue;
    }
    if (hypothesis.matches >= kAlternativePart * same->matches) {
      const double apart_m = geodesic_distance_m(hypothesis.position(), same->position());
      same->apart_m = std::max(same->apart_m, apart_m);
    }
    same->log_bayes_factor = std::max(same->log_bayes_factor, hypothesis.log_bayes_factor);
    same->was_tracked = same->was_tracked || hypothesis.was_tracked;
    if (hypothesis.odds.log() > same->odds.log()) {
      same->odds = hypothesis.odds;
      same->receiver = hypothesis.receiver;
    }
  }
  hypotheses = std::move(merged);
}

// Of a distance along a segment after some time without a measurement.
double log_density_of_arc(double off_m, double sigma_m, double since_s) {
  constexpr double kAccelerationMps2 = 2;
  const double spread_m = 0.5 + sigma_m + kAccelerationMps2 * since_s * since_s / 2;
  return -off_m * off_m / (spread_m * spread_m) / 2;
}

// The squared Mahalanobis distance of two poses in plan: east, north and heading.
double squared_sigmas_apart(const GeoCameraPose& a, const GeoCameraPose& b) {
  using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  constexpr double kMinSigmaM = 0.3;
  constexpr double kMinSigmaDeg = 0.5;
  const Matrix6 sum = Eigen::Map<const Matrix6>(a.covariance.data()) +
                      Eigen::Map<const Matrix6>(b.covariance.data());
  const std::vector<int> plan = {0, 1, 3};
  Eigen::Matrix3d covariance = sum(plan, plan);
  covariance.diagonal() += Eigen::Vector3d(kMinSigmaM, kMinSigmaM, kMinSigmaDeg).cwiseAbs2();
  const EnuPoint off = LocalFrame(a.position).enu_from_geo(b.position);
  const Eigen::Vector3d apart(off.east_m, off.north_m, turn_deg(a.heading_deg, b.heading_deg));
  return apart.dot(covariance.ldlt().solve(apart));
}

}  // namespace

GeoPoint Hypothesis::position() const { return position_of(tracker->pose(), layer().line); }

bool is_on_road(const TrackedPose& pose) {
  constexpr double kRoadsideM = 12;  // from the line
  constexpr double kSigmas = 3;
  return !pose.full ||
         std::abs(pose.full->lateral_m) <= kRoadsideM + kSigmas * pose.full->lateral_sigma_m;
}

bool Hypothesis::is_on_segment(const TrackedPose& pose) const {
  return is_on_road(pose) && pose.along_m >= -kEndMarginM &&
         pose.along_m <= layer().line.length_m() + kEndMarginM;
}

bool Hypothesis::is_carried(const TrackedPose& pose) const {
  constexpr double kMaxSigmaM = 10;
  return was_tracked && pose.full && is_on_segment(pose) &&
         pose.full->camera.sigma_in_plan_m() <= kMaxSigmaM;
}

TrackingResult Hypothesis::advance(SharedFrame& frame) {
  const double before_m = way_m();
  const GeoPoint from = position();
  const std::shared_ptr<const SegmentLayer> on = tracker->layer();
  TrackingResult result = tracker->track(frame);
  if (tracker->layer() != on) {
    const double driven_m = geodesic_distance_m(from, position());
    way_before_m = before_m + driven_m - tracker->pose().along_m;
  }
  timestamp_s = frame.timestamp_s();
  measured = result.measured;
  matches = result.matches;
  contradicted = result.contradicted;
  log_bayes_factor = result.log_bayes_factor;
  weighed = false;
  apart_m = 0;
  odds.move(way_m() - before_m);
  return result;
}

std::optional<Hypothesis> Hypothesis::continued_on(
    const std::shared_ptr<const SegmentLayer>& successor, double begin_m) const {
  auto continued = tracker->continued_on(successor, begin_m);
  if (!continued) return std::nullopt;
  const HypothesisRecord& so_far = *this;
  Hypothesis there{so_far, std::move(continued)};
  there.way_before_m += begin_m;
  return there;
}

void Hypothesis::weigh(double best, const std::optional<GnssFix>& reading) {
  weighed = true;
  odds.add_frame(log_bayes_factor, best, way_m());
  if (!reading) return;
  GnssFix against_map = *reading;  // a receiver may know the world better than the map does
  against_map.sigma_m = std::hypot(reading->sigma_m, layer().position_error.sigma_m.value_or(0));
  odds.add(receiver.log_bayes_factor(against_map, position(), timestamp_s));
}

std::vector<Hypothesis> weigh(std::vector<Hypothesis>& hypotheses,
                              const std::optional<GnssFix>& reading, std::size_t most) {
  merge_same(hypotheses);
  double best = 0;
  for (const Hypothesis& hypothesis : hypotheses)
    best = std::max(best, hypothesis.log_bayes_factor);
  for (Hypothesis& hypothesis : hypotheses) {
    if (!hypothesis.weighed) hypothesis.weigh(best, reading);
  }
  const auto unlikely =
      std::stable_partition(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& hypothesis) {
        return hypothesis.odds.log() >= kMinLogOdds ||
               hypothesis.is_carried(hypothesis.tracker->pose());
      });
  std::vector<Hypothesis> dropped(std::make_move_iterator(unlikely),
                                  std::make_move_iterator(hypotheses.end()));
  hypotheses.erase(unlikely, hypotheses.end());
  std::ranges::stable_sort(hypotheses, std::greater<>(),
                           [](const Hypothesis& hypothesis) { return hypothesis.odds.log(); });
  if (hypotheses.size() > most)
    hypotheses.erase(hypotheses.begin() + static_cast<std::ptrdiff_t>(most), hypotheses.end());
  return dropped;
}

double log_odds_of_first(const std::vector<Hypothesis>& hypotheses) {
  double against = 1;  // elsewhere
  for (std::size_t i = 1; i < hypotheses.size(); ++i) against += std::exp(hypotheses[i].odds.log());
  return hypotheses.front().odds.log() - std::log(against);
}

double log_bayes_factor_after(const Hypothesis& left, const Hypothesis& hypothesis) {
  constexpr double kElsewhereSigmas = 2;  // the distance at which it is neutral ...
  constexpr double kDegrees = 3;          // ... of the bivariate Student's t
  constexpr double kMaxAgainst = 4.6;
  const TrackedPose carried = left.tracker->pose_at(hypothesis.timestamp_s);
  const TrackedPose here = hypothesis.tracker->pose();
  const bool is_same_segment = left.layer().key == hypothesis.layer().key;
  if (!carried.full || !here.full) {
    if (!is_same_segment) return 0;
    const double since_s = hypothesis.timestamp_s - left.timestamp_s;
    return log_density_of_arc(here.along_m - carried.along_m, left.tracker->pose().sigma_m,
                              since_s);
  }
  const double squared = squared_sigmas_apart(carried.full->camera, here.full->camera);
  const double log_bayes_factor = log_student_t(squared, kDegrees) -
                                  log_student_t(kElsewhereSigmas * kElsewhereSigmas, kDegrees);
  return is_same_segment ? log_bayes_factor : std::max(log_bayes_factor, -kMaxAgainst);
}

}  // namespace milepost
