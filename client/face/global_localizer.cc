#include "client/global/global_localizer.h"

#include <milepost/global_localizer.h>

#include <cmath>
#include <utility>

#include "client/face/conversions.h"
#include "client/face/grey_image.h"
#include "client/fetch/walls.h"

namespace milepost::vehicle {
namespace {

using std::chrono::steady_clock;

GlobalStatus status_of(milepost::GlobalStatus status) {
  switch (status) {
    case milepost::GlobalStatus::tracking:
      return GlobalStatus::tracking;
    case milepost::GlobalStatus::predicted:
      return GlobalStatus::predicted;
    case milepost::GlobalStatus::lost:
      return GlobalStatus::lost;
    case milepost::GlobalStatus::initializing:
      break;
  }
  return GlobalStatus::initializing;
}

bool is_box(const Area& area) {
  const bool in_range = area.west_deg >= -180 && area.east_deg <= 180 && area.south_deg >= -90 &&
                        area.north_deg <= 90;
  return in_range && area.west_deg < area.east_deg && area.south_deg < area.north_deg;
}

Status check(const GlobalLocalizerSettings& settings) {
  if (settings.particles < 10 || settings.particles > 1'000'000) {
    return wrong("settings", "particles is not in [10, 1000000]", "pass about 2000");
  }
  if (settings.area && !is_box(*settings.area)) {
    return wrong("settings", "the area is not a valid box", "pass west < east and south < north");
  }
  if (settings.start) {
    const PosePrior& start = *settings.start;
    const bool is_sound = is_valid({start.latitude_deg, start.longitude_deg, 0}) &&
                          std::isfinite(start.sigma_m) && start.sigma_m > 0 &&
                          std::isfinite(start.heading_deg.value_or(0));
    if (!is_sound) {
      return wrong("settings", "the start is not finite or out of range",
                   "pass WGS84 degrees and a sigma above 0");
    }
  }
  return {};
}

Bounds bounds_of(const Area& area) {
  return {area.west_deg, area.south_deg, area.east_deg, area.north_deg};
}

milepost::GlobalLocalizerSettings internal_of(const GlobalLocalizerSettings& settings) {
  milepost::GlobalLocalizerSettings internal;
  internal.particles = static_cast<std::size_t>(settings.particles);
  internal.seed = settings.seed;
  if (settings.area) internal.area = bounds_of(*settings.area);
  if (settings.start) {
    internal.start =
        milepost::PosePrior{{settings.start->latitude_deg, settings.start->longitude_deg, 0},
                            settings.start->sigma_m,
                            settings.start->heading_deg};
  }
  return internal;
}

// The named map, or the only one with walls if the name is empty.
Result<MapDescription> map_to_search(MapSource& source, const std::string& name) {
  const auto maps = maps_with_walls(source);
  if (!maps) return error_of(maps.error());
  if (name.empty() && maps->size() > 1) {
    return wrong("settings", "several maps have walls", "name one of them");
  }
  for (const MapDescription& map : *maps) {
    if (name.empty() || map.version.map == name) return map;
  }
  return Error{ErrorCode::not_found, name.empty() ? "map" : "map '" + name + "'",
               "it has no layer walls", "add it with milepost-mapper aerial"};
}

struct WallsToSearch {
  std::vector<Wall> walls;
  Datum datum;
};

Result<WallsToSearch> walls_to_search(MapSource& source, const GlobalLocalizerSettings& settings) {
  const Result<MapDescription> map = map_to_search(source, settings.map);
  if (!map) return map.error();
  const Bounds area = settings.area ? bounds_of(*settings.area) : map->bounds;
  auto walls = walls_seen_from(source, map->version, area, RangeSettings{}.reach_m);
  if (!walls) return error_of(walls.error());
  if (walls->empty()) {
    return Error{ErrorCode::not_found, "map '" + map->version.map + "'",
                 "there are no walls in the area", "pass a larger area"};
  }
  return WallsToSearch{std::move(*walls), map->datum};
}

}  // namespace

const char* name_of(GlobalStatus status) {
  switch (status) {
    case GlobalStatus::initializing:
      return "initializing";
    case GlobalStatus::tracking:
      return "tracking";
    case GlobalStatus::predicted:
      return "predicted";
    case GlobalStatus::lost:
      return "lost";
  }
  return "";
}

struct GlobalLocalizer::Impl {
  Camera camera;
  milepost::GlobalLocalizer localizer;
  std::string datum;
  std::optional<double> latest_image_s;
};

Result<GlobalLocalizer> GlobalLocalizer::open(const Source& source, const Camera& camera,
                                              const GlobalLocalizerSettings& settings,
                                              const Patience& patience) {
  Status sound = check_camera(camera);
  if (sound) sound = check(settings);
  if (!sound) return sound.error();
  const auto deadline = deadline_of(patience);
  const Result<std::shared_ptr<MapSource>> opened = open_source(source);
  if (!opened) return opened.error();
  const auto is_over = [&] { return steady_clock::now() >= deadline; };
  const auto hurried =
      (*opened)->until([&] { return is_over() || (patience.cancelled && patience.cancelled()); },
                       MapSource::Asking::as_often_as_set);
  const Result<WallsToSearch> found = walls_to_search(*hurried, settings);
  if (!found && found.error().code == ErrorCode::cancelled && is_over()) {
    return Error{ErrorCode::timed_out, found.error().where, "the walls did not arrive in time",
                 "wait longer"};
  }
  if (!found) return found.error();
  return GlobalLocalizer(std::make_unique<Impl>(
      Impl{camera,
           milepost::GlobalLocalizer(found->walls, plain_camera_of(camera), internal_of(settings)),
           found->datum.text(),
           {}}));
}

GlobalLocalizer::GlobalLocalizer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GlobalLocalizer::~GlobalLocalizer() = default;
GlobalLocalizer::GlobalLocalizer(GlobalLocalizer&&) noexcept = default;
GlobalLocalizer& GlobalLocalizer::operator=(GlobalLocalizer&&) noexcept = default;

Status GlobalLocalizer::observe(const OdometryReading& reading) {
  if (Status sound = check_reading(reading); !sound) return sound;
  impl_->localizer.observe(Odometry{reading.timestamp_s, reading.speed_mps, reading.yaw_rate_dps});
  return {};
}

const std::string& GlobalLocalizer::datum() const { return impl_->datum; }

Result<GlobalFix> GlobalLocalizer::find(double timestamp_s, const ImageView& image) {
  const bool is_later = std::isfinite(timestamp_s) &&
                        (!impl_->latest_image_s || timestamp_s > *impl_->latest_image_s);
  if (!is_later) {
    return wrong("image", "its timestamp is not finite or not later than the previous one",
                 "pass images in order of time");
  }
  const Result<cv::Mat> grey = grey_image(image, impl_->camera);
  if (!grey) return grey.error();
  impl_->latest_image_s = timestamp_s;
  const GlobalPoseEstimate found = impl_->localizer.find(*grey, timestamp_s);
  GlobalFix fix;
  fix.timestamp_s = found.timestamp_s;
  fix.status = status_of(found.status);
  fix.latitude_deg = found.position.latitude_deg;
  fix.longitude_deg = found.position.longitude_deg;
  fix.heading_deg = found.heading_deg;
  fix.sigma_m = found.sigma_m;
  fix.heading_sigma_deg = found.heading_sigma_deg;
  fix.mode_probability = found.mode_probability;
  fix.inlier_ratio = found.inlier_ratio;
  return fix;
}

}  // namespace milepost::vehicle
