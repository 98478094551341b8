#include "tests/mapper/made_up_street.h"

#include <cmath>

#include "schema/geo/geodesy.h"

namespace milepost::testing {
namespace {

constexpr GeoPoint kOrigin{49, 8.4, 110};

Eigen::Vector3d ahead_of(const CameraPose& pose) {
  return {std::sin(pose.heading_rad), std::cos(pose.heading_rad), 0};
}
Eigen::Vector3d right_of(const CameraPose& pose) {
  return {std::cos(pose.heading_rad), -std::sin(pose.heading_rad), 0};
}

bool in_image(const Eigen::Vector2d& pixel) {
  return pixel.x() >= 0 && pixel.x() < kStreetCamera.width_px && pixel.y() >= 0 &&
         pixel.y() < kStreetCamera.height_px;
}

}  // namespace

MadeUpStreet::MadeUpStreet(const StreetPlan& plan) : plan_(plan), random_(plan.seed) {
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) { return sigma * normal(random_); };
  CameraPose vehicle{{0, 0, 1.5}, plan.heading_deg * kRadPerDeg, 0, 0};
  std::vector<CameraPose> road;  // extends beyond the last frame, to where it looks
  const auto seen_ahead = static_cast<std::size_t>(plan.farthest_m / kFrameSpacingM);
  for (std::size_t i = 0; i < plan.frames + seen_ahead; ++i) {
    road.push_back(vehicle);
    vehicle.enu_m += kFrameSpacingM * ahead_of(vehicle);
    vehicle.heading_rad += plan.turn_deg * kRadPerDeg;
  }
  for (std::size_t i = 0; i < plan.frames; ++i) {
    CameraPose pose = road[i];
    pose.heading_rad += plan.mounting_deg * kRadPerDeg;
    pose.pitch_rad = noise(plan.tilt_deg) * kRadPerDeg;
    pose.roll_rad = noise(plan.tilt_deg) * kRadPerDeg;
    poses.push_back(pose);
    CameraPose record = road[i];
    record.heading_rad += noise(plan.heading_noise_deg) * kRadPerDeg;
    for (int k = 0; k < 3; ++k) record.enu_m[k] += noise(plan.position_noise_m);
    if (plan.altitude_noise_m > 0) record.enu_m.z() += noise(plan.altitude_noise_m);
    recorded.push_back(record);
  }
  std::uniform_real_distribution<double> share;
  for (std::size_t i = 0; i < plan.points; ++i) {
    const auto beside = static_cast<std::size_t>(share(random_) * static_cast<double>(road.size()));
    const double side = share(random_) < 0.5 ? -1 : 1;
    const double right_m = side * (3 + 9 * share(random_));
    StreetPoint point;
    point.enu_m = road[beside].enu_m + right_m * right_of(road[beside]) +
                  kFrameSpacingM * share(random_) * ahead_of(road[beside]);
    point.enu_m.z() = 6 * share(random_);
    point.size_m = 0.1 + 0.4 * share(random_);
    points.push_back(point);
  }
}

FeatureTrack MadeUpStreet::observations_of(const StreetPoint& point) {
  std::normal_distribution<double> noise(0, plan_.pixel_noise_px);
  FeatureTrack track;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d at = point.enu_m + static_cast<double>(i) * point.step_m;
    const Eigen::Vector3d seen = point_in_camera(poses[i], at);
    if (seen.z() < plan_.nearest_m || seen.z() > plan_.farthest_m) continue;
    const Eigen::Vector2d pixel = kStreetPinhole.project(seen);
    if (!in_image(pixel)) continue;
    track.push_back({i, pixel});
    if (plan_.pixel_noise_px > 0)
      track.back().pixel += Eigen::Vector2d(noise(random_), noise(random_));
  }
  if (track.size() < 3) track.clear();
  return track;
}

std::vector<FeatureTrack> MadeUpStreet::sights_of_all() {
  std::vector<FeatureTrack> tracks;
  for (const StreetPoint& point : points) {
    FeatureTrack track = observations_of(point);
    if (!track.empty()) tracks.push_back(std::move(track));
  }
  return tracks;
}

Track MadeUpStreet::track_of(std::size_t point) {
  Track track;
  for (const PixelObservation& sight : observations_of(points[point])) {
    const Eigen::Vector3d at =
        points[point].enu_m + static_cast<double>(sight.frame) * points[point].step_m;
    const double depth_m = point_in_camera(poses[sight.frame], at).z();
    Observation observation;
    observation.along_m = static_cast<double>(sight.frame) * kFrameSpacingM;
    observation.feature = {
        static_cast<float>(sight.pixel.x()), static_cast<float>(sight.pixel.y()),
        static_cast<float>(kStreetPinhole.focal_px() * points[point].size_m / depth_m)};
    observation.descriptor = descriptor_of(point);
    track.push_back(observation);
  }
  return track;
}

Frame MadeUpStreet::frame(std::size_t i) const {
  Frame frame;
  frame.timestamp_s = 0.2 * static_cast<double>(i);
  frame.position = geo_of(recorded[i].enu_m);
  frame.heading_deg = wrapped_360(recorded[i].heading_rad / kRadPerDeg);
  return frame;
}

GeoPoint MadeUpStreet::geo_of(const Eigen::Vector3d& enu_m) {
  return LocalFrame(kOrigin).geo_from_enu({enu_m.x(), enu_m.y(), enu_m.z()});
}

Eigen::Vector3d MadeUpStreet::enu_of(const GeoPoint& position) {
  const EnuPoint enu = LocalFrame(kOrigin).enu_from_geo(position);
  return {enu.east_m, enu.north_m, enu.up_m};
}

Descriptor descriptor_of(std::size_t number) {
  std::mt19937 random(static_cast<unsigned>(number));
  Descriptor descriptor{};
  for (auto& value : descriptor) value = static_cast<std::uint8_t>(random() % 120);
  return descriptor;
}

}  // namespace milepost::testing
