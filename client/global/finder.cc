#include "client/global/finder.h"

#include <cmath>
#include <numbers>

namespace milepost {
namespace {

// What the walls' places and the mounting of the camera leave unknown, whatever the particles say.
constexpr double kLeastSigmaM = 0.5;
constexpr double kLeastHeadingSigmaDeg = 0.5;

// Longitudes are counted from the first wall's, for the walls may lie on both sides of 180 degrees.
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

WallIndex index_of(std::span<const Wall> walls, const LocalFrame& frame) {
  std::vector<PlanWall> plan;
  plan.reserve(walls.size());
  for (const Wall& wall : walls) {
    plan.push_back({plan_from_geo(frame, wall.begin.latitude_deg, wall.begin.longitude_deg),
                    plan_from_geo(frame, wall.end.latitude_deg, wall.end.longitude_deg),
                    wall.sigma_m});
  }
  return WallIndex(std::move(plan));
}

PlanBox widened(PlanBox box, double by_m) {
  box.min_m.array() -= by_m;
  box.max_m.array() += by_m;
  return box;
}

PlanBox area_of(const FinderSettings& settings, const WallIndex& walls, const LocalFrame& frame) {
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

StartBelief belief_of(const FindStart& start, const LocalFrame& frame) {
  StartBelief belief;
  belief.pose.enu_m =
      plan_from_geo(frame, start.position.latitude_deg, start.position.longitude_deg);
  belief.pose.heading_rad = start.heading_deg.value_or(0) * kRadPerDeg;
  belief.sigma_m = start.sigma_m;
  belief.heading_sigma_rad =
      start.heading_deg ? start.heading_sigma_deg * kRadPerDeg : std::numbers::pi;
  return belief;
}

FilterSettings filter_settings(const FinderSettings& settings, const LocalFrame& frame) {
  FilterSettings filter;
  filter.particles = settings.particles;
  filter.seed = settings.seed;
  if (settings.start) filter.start = belief_of(*settings.start, frame);
  return filter;
}

ObserverSettings observer_settings(const FinderSettings& settings) {
  ObserverSettings observer;
  observer.with_beams = settings.method.with_beams;
  return observer;
}

// Of all particles about a place, in each direction.
double spread_m(const ParticleCloud& cloud, const Eigen::Vector2d& about_m) {
  double sum_m2 = 0;
  double weights = 0;
  for (const Particle& particle : cloud) {
    sum_m2 += particle.weight * (particle.pose.enu_m - about_m).squaredNorm();
    weights += particle.weight;
  }
  return std::sqrt(sum_m2 / (2 * weights));
}

}  // namespace

struct Finder::Impl {
  Impl(std::span<const Wall> geographic, const Pinhole& view, const FinderSettings& settings)
      : origin(middle_of(geographic)),
        frame(origin),
        walls(index_of(geographic, frame)),
        observer(view, observer_settings(settings)),
        filter(settings.method.make_filter(walls, area_of(settings, walls, frame),
                                           filter_settings(settings, frame))) {}

  GeoPoint origin;
  LocalFrame frame;
  WallIndex walls;
  WheelLog wheels;
  WallObserver observer;
  std::unique_ptr<PlanFilter> filter;
};

Finder::Finder(std::span<const Wall> walls, const Pinhole& view, const FinderSettings& settings)
    : impl_(std::make_unique<Impl>(walls, view, settings)) {}
Finder::~Finder() = default;
Finder::Finder(Finder&&) noexcept = default;
Finder& Finder::operator=(Finder&&) noexcept = default;

void Finder::observe(const Odometry& reading) { impl_->wheels.add(reading); }

FindFix Finder::find(const cv::Mat& gray, double timestamp_s) {
  const WheelMotion motion = impl_->wheels.motion_until(timestamp_s);
  const WallObservation observation = impl_->observer.observe(gray, motion);
  const Found found = impl_->filter->update(observation, motion);
  const PlanPose& pose = found.mode.pose;
  const bool is_found =
      found.status == FindStatus::tracking || found.status == FindStatus::predicted;
  FindFix fix;
  fix.timestamp_s = timestamp_s;
  fix.status = found.status;
  fix.position = impl_->frame.geo_from_enu({pose.enu_m.x(), pose.enu_m.y(), 0});
  fix.position.altitude_m = 0;
  fix.heading_deg = wrapped_360(pose.heading_rad / kRadPerDeg);
  fix.sigma_m =
      std::hypot(kLeastSigmaM, is_found ? found.mode.sigma_m : spread_m(particles(), pose.enu_m));
  fix.heading_sigma_deg =
      std::hypot(kLeastHeadingSigmaDeg, found.mode.heading_sigma_rad / kRadPerDeg);
  fix.mass = found.mode.mass;
  fix.explained = found.explained;
  return fix;
}

const ParticleCloud& Finder::particles() const { return impl_->filter->particles(); }
const WallIndex& Finder::walls() const { return impl_->walls; }
const GeoPoint& Finder::origin() const { return impl_->origin; }

}  // namespace milepost
