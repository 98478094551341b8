#include "client/global/plan_filter.h"

#include <cmath>

namespace milepost {
namespace {

constexpr double kStandsM = 0.01;
constexpr double kStandsRad = 0.001;
constexpr double kKnownStartWayM = 20;

}  // namespace

ParticleCloud first_cloud(const FilterSettings& settings, const PlanBox& area, Random& random) {
  return settings.start ? cloud_about(*settings.start, settings.particles, random)
                        : uniform_cloud(settings.particles, area, random);
}

WatchSettings watch_settings(const FilterSettings& settings) {
  WatchSettings watch = settings.watch;
  if (settings.start) watch.found_way_m = watch.found_straight_m = kKnownStartWayM;
  return watch;
}

bool is_moving(const WheelMotion& motion) {
  return std::abs(motion.distance_m) > kStandsM || std::abs(motion.turn_rad) > kStandsRad;
}

}  // namespace milepost
