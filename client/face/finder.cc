#include "client/global/finder.h"

#include <milepost/finder.h>

#include <cmath>
#include <utility>

#include "client/face/conversions.h"
#include "client/face/grey_image.h"
#include "client/fetch/walls.h"

namespace milepost::vehicle {
namespace {

using std::chrono::steady_clock;

FinderStatus status_of(FindStatus status) {
  switch (status) {
    case FindStatus::tracking:
      return FinderStatus::tracking;
    case FindStatus::predicted:
      return FinderStatus::predicted;
    case FindStatus::lost:
      return FinderStatus::lost;
    case FindStatus::initializing:
      break;
  }
  return FinderStatus::initializing;
}

bool is_box(const Area& area) {
  const bool in_range = area.west_deg >= -180 && area.east_deg <= 180 && area.south_deg >= -90 &&
                        area.north_deg <= 90;
  return in_range && area.west_deg < area.east_deg && area.south_deg < area.north_deg;
}

Status check(const FinderSettings& settings) {
  if (settings.particles < 10 || settings.particles > 1'000'000) {
    return wrong("settings", "particles are not from 10 to 1000000", "give 2000 or so");
  }
  if (settings.area && !is_box(*settings.area)) {
    return wrong("settings", "the area is no box", "give west below east and south below north");
  }
  if (settings.start) {
    const FinderStart& start = *settings.start;
    const bool is_sound = is_valid({start.latitude_deg, start.longitude_deg, 0}) &&
                          std::isfinite(start.sigma_m) && start.sigma_m > 0 &&
                          std::isfinite(start.heading_deg.value_or(0));
    if (!is_sound) {
      return wrong("settings", "the start is not finite or out of range",
                   "give degrees of WGS84 and a sigma above 0");
    }
  }
  return {};
}

Bounds bounds_of(const Area& area) {
  return {area.west_deg, area.south_deg, area.east_deg, area.north_deg};
}

milepost::FinderSettings internal_of(const FinderSettings& settings) {
  milepost::FinderSettings internal;
  internal.particles = static_cast<std::size_t>(settings.particles);
  internal.seed = settings.seed;
  if (settings.area) internal.area = bounds_of(*settings.area);
  if (settings.start) {
    internal.start = FindStart{{settings.start->latitude_deg, settings.start->longitude_deg, 0},
                               settings.start->sigma_m,
                               settings.start->heading_deg};
  }
  return internal;
}

// The map that is asked for, or the only one that has walls.
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
               "it has no layer of walls", "add them with milepost-mapper aerial"};
}

Result<std::vector<Wall>> walls_to_search(MapSource& source, const FinderSettings& settings) {
  const Result<MapDescription> map = map_to_search(source, settings.map);
  if (!map) return map.error();
  const Bounds area = settings.area ? bounds_of(*settings.area) : map->bounds;
  auto walls = walls_seen_from(source, map->version, area, RangeSettings{}.reach_m);
  if (!walls) return error_of(walls.error());
  if (walls->empty()) {
    return Error{ErrorCode::not_found, "map '" + map->version.map + "'",
                 "there are no walls in the area", "widen it"};
  }
  return std::move(*walls);
}

}  // namespace

const char* name_of(FinderStatus status) {
  switch (status) {
    case FinderStatus::initializing:
      return "initializing";
    case FinderStatus::tracking:
      return "tracking";
    case FinderStatus::predicted:
      return "predicted";
    case FinderStatus::lost:
      return "lost";
  }
  return "";
}

struct Finder::Impl {
  Camera camera;
  milepost::Finder finder;
  std::optional<double> latest_image_s;
};

Result<Finder> Finder::open(const Source& source, const Camera& camera,
                            const FinderSettings& settings, const Patience& patience) {
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
  const Result<std::vector<Wall>> walls = walls_to_search(*hurried, settings);
  if (!walls && walls.error().code == ErrorCode::cancelled && is_over()) {
    return Error{ErrorCode::timed_out, walls.error().where, "the walls did not arrive in time",
                 "wait longer"};
  }
  if (!walls) return walls.error();
  return Finder(std::make_unique<Impl>(
      Impl{camera,
           milepost::Finder(*walls, plain_camera_of(camera).pinhole, internal_of(settings)),
           {}}));
}

Finder::Finder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Finder::~Finder() = default;
Finder::Finder(Finder&&) noexcept = default;
Finder& Finder::operator=(Finder&&) noexcept = default;

Status Finder::observe(const OdometryReading& reading) {
  if (Status sound = check_reading(reading); !sound) return sound;
  impl_->finder.observe(Odometry{reading.timestamp_s, reading.speed_mps, reading.yaw_rate_dps});
  return {};
}

Result<FinderFix> Finder::find(double timestamp_s, const ImageView& image) {
  const bool is_later = std::isfinite(timestamp_s) &&
                        (!impl_->latest_image_s || timestamp_s > *impl_->latest_image_s);
  if (!is_later) {
    return wrong("image", "its time is not finite or not after that of the one before",
                 "give them in order");
  }
  const Result<cv::Mat> grey = grey_image(image, impl_->camera);
  if (!grey) return grey.error();
  impl_->latest_image_s = timestamp_s;
  const FindFix found = impl_->finder.find(*grey, timestamp_s);
  FinderFix fix;
  fix.timestamp_s = found.timestamp_s;
  fix.status = status_of(found.status);
  fix.latitude_deg = found.position.latitude_deg;
  fix.longitude_deg = found.position.longitude_deg;
  fix.heading_deg = found.heading_deg;
  fix.sigma_m = found.sigma_m;
  fix.heading_sigma_deg = found.heading_sigma_deg;
  fix.mass = found.mass;
  fix.explained = found.explained;
  return fix;
}

}  // namespace milepost::vehicle
