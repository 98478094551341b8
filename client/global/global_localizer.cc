#include "client/global/global_localizer.h"

#include <cmath>
#include <numbers>

namespace milepost {
namespace {

// Errors of the walls' positions and of the camera's mounting, which the particles do not contain.
constexpr double kLeastSigmaM = 0.5;
constexpr double kLeastHeadingSigmaDeg = 0.5;

// Longitudes are relative to the first wall's, since the walls may lie on both sides of 180
// degrees.
GeoPoint middle_of(std::span<const Wall> walls) {
  const double from_deg = walls.front().begin.longitude_deg;
  const auto box_of = [&](const Wall& wall) {
    Bounds box = bounds_of(wall);
    const double turn_deg = std::round((box.west_deg - from_deg) / 360) * 360;
    box.west_deg -= turn_deg;
    box.east_deg -= turn_deg;
    return box;
  };
  Bounds box = box_of(walls.front());
  for (const Wall& wall : walls) box = box.joined(box_of(wall));
  const double longitude_deg = (box.west_deg + box.east_deg) / 2;
  return {(box.south_deg + box.north_deg) / 2,
          longitude_deg - std::round(longitude_deg / 360) * 360, 0};
}

Eigen::Vector2d plan_from_geo(const LocalFrame& frame, double latitude_deg, double longitude_deg) {
  const EnuPoint enu = frame.enu_from_geo({latitude_deg, longitude_deg, 0});
  return {enu.east_m, enu.north_m};
}

RayCastingGrid index_of(std::span<const Wall> walls, const LocalFrame& frame) {
  std::vector<PlanWall> plan;
  plan.reserve(walls.size());
  for (const Wall& wall : walls) {
    plan.push_back({plan_from_geo(frame, wall.begin.latitude_deg, wall.begin.longitude_deg),
                    plan_from_geo(frame, wall.end.latitude_deg, wall.end.longitude_deg),
                    wall.sigma_m});
  }
  return RayCastingGrid(std::move(plan));
}

PlanBox widened(PlanBox box, double by_m) {
  box.min_m.array() -= by_m;
  box.max_m.array() += by_m;
  return box;
}

PlanBox area_of(const GlobalLocalizerSettings& settings, const RayCastingGrid& walls,
                const LocalFrame& frame) {
  if (!settings.area) {
    PlanBox box = walls.bounds();
    if (settings.start) {
      const GeoPoint& start = settings.start->position;
      const Eigen::Vector2d start_m = plan_from_geo(frame, start.latitude_deg, start.longitude_deg);
      const PlanBox about_start = widened({start_m, start_m}, 3 * settings.start->sigma_m);
      box = {box.min_m.cwiseMin(about_start.min_m), box.max_m.cwiseMax(about_start.max_m)};
    }
    return widened(box, settings.area_margin_m);
  }
  const Bounds& area = *settings.area;
  return {plan_from_geo(frame, area.south_deg, area.west_deg),
          plan_from_geo(frame, area.north_deg, area.east_deg)};
}

StartBelief belief_of(const PosePrior& start, const LocalFrame& frame) {
  StartBelief belief;
  belief.pose.enu_m =
      plan_from_geo(frame, start.position.latitude_deg, start.position.longitude_deg);
  belief.pose.heading_rad = start.heading_deg.value_or(0) * kRadPerDeg;
  belief.sigma_m = start.sigma_m;
  belief.heading_sigma_rad =
      start.heading_deg ? start.heading_sigma_deg * kRadPerDeg : std::numbers::pi;
  return belief;
}

FilterSettings filter_settings(const GlobalLocalizerSettings& settings, const LocalFrame& frame) {
  FilterSettings filter;
  filter.particles = settings.particles;
  filter.seed = settings.seed;
  if (settings.start) filter.start = belief_of(*settings.start, frame);
  return filter;
}

ObserverSettings observer_settings(const GlobalLocalizerSettings& settings) {
  ObserverSettings observer;
  observer.with_beams = settings.method.with_beams;
  return observer;
}

// The standard deviation of all particles around a position, per axis.
double spread_m(const ParticleSet& particles, const Eigen::Vector2d& about_m) {
  double sum_m2 = 0;
  double weights = 0;
  for (const Particle& particle : particles) {
    sum_m2 += particle.weight * (particle.pose.enu_m - about_m).squaredNorm();
    weights += particle.weight;
  }
  return std::sqrt(sum_m2 / (2 * weights));
}

}  // namespace

struct GlobalLocalizer::Impl {
  Impl(std::span<const Wall> geographic, const Camera& camera,
       const GlobalLocalizerSettings& settings)
      : origin(middle_of(geographic)),
        frame(origin),
        walls(index_of(geographic, frame)),
        observer(camera, observer_settings(settings)),
        filter(settings.method.make_filter(walls, area_of(settings, walls, frame),
                                           filter_settings(settings, frame))) {}

  GeoPoint origin;
  LocalFrame frame;
  RayCastingGrid walls;
  OdometryBuffer odometry;
  WallObserver observer;
  std::unique_ptr<PlanFilter> filter;
};

GlobalLocalizer::GlobalLocalizer(std::span<const Wall> walls, const Camera& camera,
                                 const GlobalLocalizerSettings& settings)
    : impl_(std::make_unique<Impl>(walls, camera, settings)) {}
GlobalLocalizer::~GlobalLocalizer() = default;
GlobalLocalizer::GlobalLocalizer(GlobalLocalizer&&) noexcept = default;
GlobalLocalizer& GlobalLocalizer::operator=(GlobalLocalizer&&) noexcept = default;

void GlobalLocalizer::observe(const Odometry& reading) { impl_->odometry.add(reading); }

GlobalPoseEstimate GlobalLocalizer::find(const cv::Mat& gray, double timestamp_s) {
  const OdometryIncrement motion = impl_->odometry.motion_until(timestamp_s);
  const WallObservation observation = impl_->observer.observe(gray, motion);
  const PlanEstimate found = impl_->filter->update(observation, motion);
  const Pose2& pose = found.mode.pose;
  const bool is_found =
      found.status == GlobalStatus::tracking || found.status == GlobalStatus::predicted;
  GlobalPoseEstimate fix;
  fix.timestamp_s = timestamp_s;
  fix.status = found.status;
  fix.position = impl_->frame.geo_from_enu({pose.enu_m.x(), pose.enu_m.y(), 0});
  fix.position.altitude_m = 0;
  fix.heading_deg = wrapped_360(pose.heading_rad / kRadPerDeg);
  fix.sigma_m =
      std::hypot(kLeastSigmaM, is_found ? found.mode.sigma_m : spread_m(particles(), pose.enu_m));
  fix.heading_sigma_deg =
      std::hypot(kLeastHeadingSigmaDeg, found.mode.heading_sigma_rad / kRadPerDeg);
  fix.mode_probability = found.mode.probability;
  fix.inlier_ratio = found.inlier_ratio;
  return fix;
}

const ParticleSet& GlobalLocalizer::particles() const { return impl_->filter->particles(); }
const RayCastingGrid& GlobalLocalizer::walls() const { return impl_->walls; }
const GeoPoint& GlobalLocalizer::origin() const { return impl_->origin; }

}  // namespace milepost
