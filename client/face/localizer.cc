#include "client/localize/localizer.h"

#include <milepost/localizer.h>

#include <cmath>
#include <mutex>
#include <utility>

#include "client/face/conversions.h"
#include "client/face/grey_image.h"
#include "client/face/map_ahead.h"
#include "schema/feature/extractor.h"

namespace milepost::vehicle {
namespace {

FixStatus status_of(milepost::FixStatus status) {
  switch (status) {
    case milepost::FixStatus::tracking:
      return FixStatus::tracking;
    case milepost::FixStatus::predicted:
      return FixStatus::predicted;
    case milepost::FixStatus::lost:
      return FixStatus::lost;
    case milepost::FixStatus::off_map:
      return FixStatus::off_map;
    case milepost::FixStatus::initializing:
      break;
  }
  return FixStatus::initializing;
}

}  // namespace

const char* name_of(FixStatus status) {
  switch (status) {
    case FixStatus::initializing:
      return "initializing";
    case FixStatus::tracking:
      return "tracking";
    case FixStatus::predicted:
      return "predicted";
    case FixStatus::lost:
      return "lost";
    case FixStatus::off_map:
      return "off-map";
  }
  return "";
}

struct Localizer::Impl {
  Impl(const std::shared_ptr<MapSource>& source, Camera given,
       const milepost::LocalizerSettings& settings)
      : camera(std::move(given)), localizer(source, plain_camera_of(camera), settings) {}

  const FeatureSet& features_of(const cv::Mat& grey, const FeatureParameters& wanted) {
    if (!extractor || !(wanted == parameters)) {
      extractor = std::make_unique<FeatureExtractor>(wanted, plain_camera_of(camera));
      parameters = wanted;
    }
    features = extractor->extract(grey);
    return features;
  }

  // REQUIRES: the mutex is held.
  void remember(const milepost::Fix& fix);
  Fix face_of(const milepost::Fix& internal) const;

  Camera camera;
  milepost::Localizer localizer;
  std::unique_ptr<FeatureExtractor> extractor;
  FeatureParameters parameters;
  FeatureSet features;
  std::optional<double> latest_image_s;
  std::optional<double> latest_receiver_s;
  std::optional<double> latest_odometry_s;

  mutable std::mutex mutex;  // guards all below
  std::optional<OnSegment> latest_place;
  std::string datum;  // of the map that the latest pose rests on
};

void Localizer::Impl::remember(const milepost::Fix& fix) {
  latest_place.reset();
  if (!fix.along_m) return;
  latest_place = OnSegment{{fix.version, fix.segment}, *fix.along_m};
  const auto held = localizer.provider().held();
  const HeldSegment* segment = held->find(latest_place->key);
  if (segment != nullptr && segment->layer) datum = segment->layer->build->datum.text();
}

Fix Localizer::Impl::face_of(const milepost::Fix& internal) const {
  Fix fix;
  fix.timestamp_s = internal.timestamp_s;
  fix.status = status_of(internal.status);
  fix.map = internal.version.map;
  fix.build = internal.version.build;
  fix.segment = internal.segment;
  fix.along_m = internal.along_m;
  fix.sigma_m = internal.sigma_m;
  fix.sigma_map_m = internal.sigma_map_m;
  fix.lateral_m = internal.lateral_m;
  fix.lateral_sigma_m = internal.lateral_sigma_m;
  if (internal.camera) {
    fix.pose = vehicle_pose_of(*internal.camera, camera.mounting);
    fix.datum = datum;
  }
  fix.matches = internal.matches;
  return fix;
}

Result<Localizer> Localizer::open(const Source& source, const Camera& camera,
                                  const LocalizerSettings& settings) {
  const Status sound = check_camera(camera);
  if (!sound) return sound.error();
  if (!(settings.ahead_m >= 0 && settings.ahead_m <= 5000)) {
    return wrong("settings", "ahead_m is not in [0, 5000]", "pass metres of map ahead");
  }
  const Result<std::shared_ptr<MapSource>> opened = open_source(source);
  if (!opened) return opened.error();
  milepost::LocalizerSettings internal;
  internal.prefetch_m = settings.ahead_m;
  return Localizer(std::make_unique<Impl>(*opened, camera, internal));
}

Localizer::Localizer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

Status Localizer::observe(const ReceiverReading& reading) {
  const GeoPoint position = {reading.latitude_deg, reading.longitude_deg, reading.altitude_m};
  const bool is_sound = std::isfinite(reading.timestamp_s) && is_valid(position) &&
                        std::isfinite(reading.altitude_m) && std::isfinite(reading.sigma_m) &&
                        reading.sigma_m > 0 && std::isfinite(reading.heading_deg.value_or(0));
  if (!is_sound) {
    return wrong("receiver reading", "a value is not finite or out of range",
                 "pass WGS84 degrees and a sigma above 0");
  }
  if (impl_->latest_receiver_s && reading.timestamp_s < *impl_->latest_receiver_s) {
    return wrong("receiver reading", "it is earlier than the previous one",
                 "pass readings in order of time");
  }
  impl_->latest_receiver_s = reading.timestamp_s;
  impl_->localizer.observe(
      GnssFix{reading.timestamp_s, position, reading.sigma_m, reading.heading_deg});
  return {};
}

Status Localizer::observe(const OdometryReading& reading) {
  if (Status sound = check_reading(reading); !sound) return sound;
  if (impl_->latest_odometry_s && reading.timestamp_s <= *impl_->latest_odometry_s) {
    return wrong("odometry reading", "it is not later than the previous one",
                 "pass readings in order of time");
  }
  impl_->latest_odometry_s = reading.timestamp_s;
  impl_->localizer.observe(Odometry{reading.timestamp_s, reading.speed_mps, reading.yaw_rate_dps});
  return {};
}

Status Localizer::expect_route(const std::vector<RoutePoint>& route) {
  std::vector<GeoPoint> positions;
  positions.reserve(route.size());
  for (const RoutePoint& point : route)
    positions.push_back({point.latitude_deg, point.longitude_deg, 0});
  if (route.empty()) {
    impl_->localizer.expect({});
    return {};
  }
  milepost::Result<ExpectedRoute> expected = ExpectedRoute::through(std::move(positions));
  if (!expected) {
    return wrong("route", expected.error().what,
                 "pass two WGS84 positions or more, in driving order");
  }
  impl_->localizer.expect(std::move(*expected));
  return {};
}

Result<Fix> Localizer::localize(double timestamp_s, const ImageView& image) {
  if (!std::isfinite(timestamp_s)) {
    return wrong("image", "its timestamp is not finite", "pass seconds of the vehicle's clock");
  }
  if (impl_->latest_image_s && timestamp_s <= *impl_->latest_image_s) {
    return wrong("image", "its timestamp is not later than the previous one",
                 "pass images in order of time");
  }
  const Result<cv::Mat> grey = grey_image(image, impl_->camera);
  if (!grey) return grey.error();
  impl_->latest_image_s = timestamp_s;
  const QueryFrame frame{timestamp_s, [&](const FeatureParameters& wanted) -> const FeatureSet& {
                           return impl_->features_of(*grey, wanted);
                         }};
  const milepost::Result<milepost::Fix> fix = impl_->localizer.localize(frame);
  if (!fix) return error_of(fix.error());
  const std::lock_guard lock(impl_->mutex);
  impl_->remember(*fix);
  return impl_->face_of(*fix);
}

Fix Localizer::fix_at(double timestamp_s) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->face_of(impl_->localizer.fix_at(timestamp_s));
}

MapAhead Localizer::map_ahead() const {
  std::optional<OnSegment> from;
  {
    const std::lock_guard lock(impl_->mutex);
    from = impl_->latest_place;
  }
  const TileProvider& provider = impl_->localizer.provider();
  return map_ahead_of(*provider.held(), provider.wanted(), from);
}

Status Localizer::wait_for_map(double timestamp_s, const Patience& patience) {
  if (impl_->localizer.wait_for_tiles(timestamp_s, deadline_of(patience), patience.cancelled)) {
    return {};
  }
  if (patience.cancelled && patience.cancelled()) {
    return Error{ErrorCode::cancelled, "map", "stopped on request", ""};
  }
  return Error{ErrorCode::timed_out, "map", "it has not arrived completely in time",
               "wait longer, or continue without it"};
}

}  // namespace milepost::vehicle
