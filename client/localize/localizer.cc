#include "client/localize/localizer.h"

#include <algorithm>
#include <cmath>

#include "client/localize/follower.h"
#include "client/localize/segment_session.h"

namespace milepost {
namespace {

constexpr double kMaxStartTurnDeg = 60;    // between a heading that is known and a segment's
constexpr double kCoarseSpeedMps = 20;     // how fast a coarse position grows old
constexpr double kMaxOdometryAgeS = 0.5;   // at a start
constexpr std::size_t kMaxCandidates = 4;  // segments tried at a start
constexpr double kEndMarginM = 3;          // the vehicle may be so far beyond a segment's ends

struct Start {
  Sighting sighting;
  NearbySegment where;
};

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
  std::shared_ptr<MapSource> source;
  QueryCamera camera;
  LocalizerSettings settings;
  std::unique_ptr<Prefetcher> prefetcher;  // empty if turned off

  std::optional<CoarsePosition> coarse;     // what a start goes by
  std::optional<Odometry> odometry;         // the latest
  std::unique_ptr<SegmentSession> session;  // the segment the vehicle is or last was on
  std::unique_ptr<Follower> follower;       // with the session
  bool tracked = false;                     // the follower was started and not given up
  int frames_without_measurement = 0;
  bool was_tracked = false;
  double prefetched_to_m = 0;
  std::optional<Error> noted;

  Result<Fix> start(const QueryFrame& frame);
  Result<std::optional<Start>> find_start(const QueryFrame& frame,
                                          const std::vector<NearbySegment>& candidates);
  bool coarse_is_fresh(double timestamp_s) const;
  bool may_be_followed(const NearbySegment& where) const;
  bool is_contradicted(double timestamp_s) const;
  Status enter(const NearbySegment& where);
  Result<Fix> track(const QueryFrame& frame);
  void leave(double timestamp_s);
  void prefetch_ahead();
  Fix unlocated(const QueryFrame& frame, FixStatus status) const;
  Fix located(const QueryFrame& frame, FixStatus status, int matches) const;
};

Localizer::Localizer(std::shared_ptr<MapSource> source, const QueryCamera& camera,
                     const LocalizerSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  impl_->source = std::move(source);
  impl_->camera = camera;
  impl_->settings = settings;
  if (settings.prefetch_m > 0) impl_->prefetcher = std::make_unique<Prefetcher>(impl_->source);
}

Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::observe(const CoarsePosition& position) { impl_->coarse = position; }

void Localizer::observe(const Odometry& odometry) {
  const bool is_sound = std::isfinite(odometry.speed_mps) && std::isfinite(odometry.yaw_rate_dps);
  const bool ascends = !impl_->odometry || odometry.timestamp_s > impl_->odometry->timestamp_s;
  if (!is_sound || !ascends) return;
  impl_->odometry = odometry;
  if (impl_->tracked) impl_->follower->observe(odometry);
}

const std::optional<Error>& Localizer::noted_error() const { return impl_->noted; }

Result<Fix> Localizer::localize(const QueryFrame& frame) {
  return impl_->tracked ? impl_->track(frame) : impl_->start(frame);
}

Fix Localizer::Impl::unlocated(const QueryFrame& frame, FixStatus status) const {
  Fix fix;
  fix.timestamp_s = frame.timestamp_s;
  fix.status = status;
  return fix;
}

Fix Localizer::Impl::located(const QueryFrame& frame, FixStatus status, int matches) const {
  const TrackedPosition position = follower->position();
  Fix fix = unlocated(frame, status);
  fix.version = session->layer.version;
  fix.segment = session->layer.segment;
  fix.along_m = std::clamp(position.along_m, 0.0, session->line.length_m());
  fix.sigma_m = position.sigma_m;
  fix.position = session->line.point_at(*fix.along_m);
  if (position.across) {
    fix.lateral_m = position.across->lateral_m;
    fix.lateral_sigma_m = position.across->lateral_sigma_m;
    fix.heading_deg = position.across->heading_deg;
    fix.position = position.across->position;
  }
  fix.matches = matches;
  return fix;
}

bool Localizer::Impl::coarse_is_fresh(double timestamp_s) const {
  return coarse && timestamp_s - coarse->timestamp_s <= settings.max_coarse_age_s;
}

// Whether the entered segment leads where the vehicle looks, as far as that is known.
bool Localizer::Impl::may_be_followed(const NearbySegment& where) const {
  if (!coarse->heading_deg) return true;
  const double turn_deg = *coarse->heading_deg - session->line.heading_deg_at(where.along_m);
  return std::abs(std::remainder(turn_deg, 360)) <= kMaxStartTurnDeg;
}

// Whether a fresh position of the receiver is too far from where the camera is followed.
bool Localizer::Impl::is_contradicted(double timestamp_s) const {
  if (!coarse_is_fresh(timestamp_s)) return false;
  const GeoPoint here = session->line.point_at(follower->position().along_m);
  const double age_s = timestamp_s - coarse->timestamp_s;
  return geodesic_distance_m(here, coarse->position) >
         settings.contradiction_sigmas * coarse->sigma_m + settings.contradiction_reach_m +
             kCoarseSpeedMps * age_s;
}

Status Localizer::Impl::enter(const NearbySegment& where) {
  if (session && session->layer.version == where.version && session->layer.segment == where.segment)
    return ok_status();
  Result<SegmentSession> opened =
      open_session({source, where.version, where.segment, settings.method.layer});
  if (!opened) return opened.error();
  follower.reset();  // it knows the old session
  session = std::make_unique<SegmentSession>(std::move(*opened));
  Result<std::unique_ptr<Follower>> made = make_follower(*session, camera, settings);
  if (!made) {
    session.reset();
    return made.error();
  }
  follower = std::move(*made);
  prefetched_to_m = 0;
  return ok_status();
}

Result<std::optional<Start>> Localizer::Impl::find_start(
    const QueryFrame& frame, const std::vector<NearbySegment>& candidates) {
  const double age_s = frame.timestamp_s - coarse->timestamp_s;
  const double reach_m =
      settings.start_sigmas * coarse->sigma_m + settings.start_reach_m + kCoarseSpeedMps * age_s;
  std::optional<Start> best;
  for (const NearbySegment& candidate : candidates) {
    const Status entered = enter(candidate);
    if (!entered.ok()) return entered.error();
    if (!may_be_followed(candidate)) continue;
    const AlongRange around = AlongRange{candidate.along_m, candidate.along_m}.widened(reach_m);
    const Result<std::optional<Sighting>> seen = follower->find(frame, around);
    if (!seen) return seen.error();
    if (!*seen) continue;
    if (!best || (*seen)->merit > best->sighting.merit) best = Start{**seen, candidate};
  }
  return best;
}

Result<Fix> Localizer::Impl::start(const QueryFrame& frame) {
  const FixStatus waiting = was_tracked ? FixStatus::lost : FixStatus::initializing;
  if (!coarse_is_fresh(frame.timestamp_s)) return unlocated(frame, waiting);
  const double radius_m = settings.start_radius_m + settings.start_sigmas * coarse->sigma_m;
  Result<std::vector<NearbySegment>> near = source->segments_near(coarse->position, radius_m);
  if (!near) return near.error();
  if (near->empty()) return unlocated(frame, FixStatus::off_map);
  if (near->size() > kMaxCandidates) near->resize(kMaxCandidates);
  const Result<std::optional<Start>> found = find_start(frame, *near);
  if (!found) return found.error();
  if (!*found) return unlocated(frame, waiting);

  const Status entered = enter((*found)->where);
  if (!entered.ok()) return entered.error();
  const Result<int> matches = follower->start(frame, (*found)->sighting);
  if (!matches) return matches.error();
  if (odometry && frame.timestamp_s - odometry->timestamp_s <= kMaxOdometryAgeS)
    follower->observe(*odometry);
  tracked = true;
  frames_without_measurement = 0;
  was_tracked = true;
  return located(frame, FixStatus::initializing, *matches);
}

Result<Fix> Localizer::Impl::track(const QueryFrame& frame) {
  const double expected_m = follower->expected_along_m(frame.timestamp_s);
  if (expected_m < -kEndMarginM || expected_m > session->line.length_m() + kEndMarginM) {
    tracked = false;
    was_tracked = false;
    const Result<Fix> elsewhere = start(frame);  // perhaps another segment begins here
    if (elsewhere && elsewhere->along_m) return elsewhere;
    return unlocated(frame, FixStatus::off_map);
  }
  const Followed followed = follower->follow(frame);
  if (followed.failure) noted = followed.failure;
  if (followed.failure && followed.failure->code == ErrorCode::gone) {  // rebuilt meanwhile
    leave(frame.timestamp_s);
    return start(frame);
  }
  if (followed.measured && !is_contradicted(frame.timestamp_s)) {
    frames_without_measurement = 0;
    prefetch_ahead();
    return located(frame, FixStatus::tracking, followed.matches);
  }
  if (++frames_without_measurement <= settings.max_predicted_frames) {
    return located(frame, FixStatus::predicted, 0);
  }
  leave(frame.timestamp_s);
  return start(frame);
}

// Gives up the tracked position, and keeps it to start again from unless a receiver knows more.
void Localizer::Impl::leave(double timestamp_s) {
  const TrackedPosition last = follower->position();
  tracked = false;
  if (!coarse_is_fresh(timestamp_s)) {
    coarse = CoarsePosition{timestamp_s, session->line.point_at(last.along_m),
                            std::max(last.sigma_m, 5.0)};
  }
  follower.reset();
  session.reset();
}

void Localizer::Impl::prefetch_ahead() {
  if (!prefetcher) return;
  const double at_m = follower->position().along_m;
  if (at_m + settings.prefetch_m / 2 < prefetched_to_m) return;
  const AlongRange ahead = {at_m, at_m + settings.prefetch_m};
  if (prefetched_to_m < session->line.length_m()) {
    prefetcher->request(session->layer.version, session->layer.segment, settings.method.layer,
                        ahead);
  }
  prefetched_to_m = ahead.to_m;
}

}  // namespace milepost
