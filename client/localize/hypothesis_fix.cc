#include "client/localize/hypothesis_fix.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

// Adds an isotropic variance in the horizontal plane.
void widen_in_plan(GeoCameraPose& camera, double sigma_m) {
  camera.covariance[0] += sigma_m * sigma_m;
  camera.covariance[7] += sigma_m * sigma_m;
}

}  // namespace

Fix unlocated(double timestamp_s, FixStatus status) {
  Fix fix;
  fix.timestamp_s = timestamp_s;
  fix.status = status;
  return fix;
}

Fix fix_of(const Hypothesis& hypothesis, FixStatus status) {
  Fix fix = fix_of(hypothesis, hypothesis.tracker->pose(), hypothesis.timestamp_s, status);
  fix.matches = hypothesis.measured ? hypothesis.matches : 0;
  return fix;
}

Fix fix_of(const Hypothesis& hypothesis, const TrackedPose& pose, double timestamp_s,
           FixStatus status) {
  const RouteLine& line = hypothesis.layer().line;
  Fix fix = unlocated(timestamp_s, status);
  fix.version = hypothesis.layer().key.version;
  fix.segment = hypothesis.layer().key.segment;
  fix.along_m = std::clamp(pose.along_m, 0.0, line.length_m());
  const double map_sigma_m = hypothesis.layer().position_error.sigma_m.value_or(0);
  const double shared_m = std::hypot(hypothesis.apart_m, map_sigma_m);
  fix.sigma_m = std::hypot(pose.sigma_m, shared_m);
  fix.sigma_map_m = std::hypot(pose.sigma_m, hypothesis.apart_m);
  fix.position = line.point_at(*fix.along_m);
  if (pose.full) {
    fix.lateral_m = pose.full->lateral_m;
    fix.lateral_sigma_m = std::hypot(pose.full->lateral_sigma_m, shared_m);
    fix.camera = pose.full->camera;
    widen_in_plan(*fix.camera, shared_m);
    fix.heading_deg = fix.camera->heading_deg;
    fix.position = fix.camera->position;
  }
  return fix;
}

void carry_on(Fix& fix, const Hypothesis& hypothesis, double timestamp_s) {
  fix.camera = hypothesis.tracker->pose_at(timestamp_s).full->camera;
  fix.position = fix.camera->position;
  fix.heading_deg = fix.camera->heading_deg;
  fix.sigma_map_m = fix.camera->sigma_in_plan_m();
  widen_in_plan(*fix.camera, hypothesis.layer().position_error.sigma_m.value_or(0));
  fix.sigma_m = fix.camera->sigma_in_plan_m();
}

void widen(Fix& fix, double log_odds, const Hypothesis& hypothesis,
           const std::vector<Hypothesis>& hypotheses, const std::optional<GnssFix>& reading) {
  const GeoPoint here = hypothesis.position();
  double weights = 1 + std::exp(log_odds);
  double square_m2 = kUnknownM * kUnknownM;
  if (reading) {
    const double sigma_m = std::max(kElsewhereM, reading->sigma_m);
    square_m2 = sigma_m * sigma_m + std::pow(geodesic_distance_m(here, reading->position), 2);
  }
  for (const Hypothesis& other : hypotheses) {
    if (&other == &hypothesis) continue;
    const double weight = std::exp(other.odds.log());
    weights += weight;
    square_m2 += weight * std::pow(geodesic_distance_m(here, other.position()), 2);
  }
  const double spread_m = std::sqrt(square_m2 / weights);
  fix.sigma_m = std::hypot(fix.sigma_m, spread_m);
  fix.sigma_map_m = std::hypot(fix.sigma_map_m, spread_m);
  if (fix.lateral_sigma_m) fix.lateral_sigma_m = std::hypot(*fix.lateral_sigma_m, spread_m);
  if (fix.camera) widen_in_plan(*fix.camera, spread_m);
}

}  // namespace milepost
