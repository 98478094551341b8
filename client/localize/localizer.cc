#include "client/localize/localizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "client/fetch/prefetcher.h"
#include "client/localize/place.h"
#include "client/localize/second_look.h"

namespace milepost {
namespace {

constexpr double kMaxStartTurnDeg = 60;    // between a heading that is known and a segment's
constexpr double kMaxOdometryAgeS = 0.5;   // at a start
constexpr std::size_t kMaxCandidates = 4;  // segments searched
constexpr double kElsewhereM = 5;          // how far off elsewhere is at least ...
constexpr double kUnknownM = 30;           // ... and where no receiver tells
constexpr double kDoubt = -1;              // a frame that says less leaves the place in doubt

// No place is claimed: those that may be it are weighed against each other and elsewhere.
struct Searching {
  FixStatus waiting =
      FixStatus::initializing;  // what to say until one is: initializing, lost, off_map
  std::vector<Place> places = {};
  std::optional<CoarsePosition> lost_at = {};  // where the place was that was followed last
  std::optional<Place> left = {};              // ... that went over an end of its segment

  void leave(Place place) {
    waiting = FixStatus::off_map;
    left = std::move(place);
  }
};

// One place is claimed and followed.
struct Following {
  Place place;
  int frames_without_measurement = 0;
  SecondLook second_look = {};
};

}  // namespace

struct Localizer::Impl {
  std::shared_ptr<MapSource> source;
  QueryCamera camera;
  LocalizerSettings settings;
  std::unique_ptr<Prefetcher> prefetcher;  // empty if turned off

  std::optional<CoarsePosition> coarse;  // the receiver's latest
  std::optional<Odometry> odometry;      // the latest
  std::variant<Searching, Following> state = Searching{};
  std::vector<std::shared_ptr<OpenSegment>> segments;  // opened last, the latest at the end
  double prefetched_to_m = 0;
  std::optional<Error> noted;

  Result<Fix> search(SeenFrame& frame);
  Result<Fix> follow(SeenFrame& frame);

  std::optional<CoarsePosition> fresh(const std::optional<CoarsePosition>& position,
                                      double timestamp_s) const;
  Result<double> scout(SeenFrame& frame, const CoarsePosition& around, Searching& searching);
  Result<std::shared_ptr<OpenSegment>> opened(const NearbySegment& where);
  void carry(Searching& searching, SeenFrame& frame);
  Fix weighed(Searching& searching, double timestamp_s);
  void look_again(Following& following, SeenFrame& frame) const;
  void claim(Place place);
  void prefetch_ahead(const Place& place);
  Fix located(const Place& place, FixStatus status) const;
  void widen(Fix& fix, double log_odds, const Place& place, const std::vector<Place>& places) const;
};

namespace {

Fix unlocated(double timestamp_s, FixStatus status) {
  Fix fix;
  fix.timestamp_s = timestamp_s;
  fix.status = status;
  return fix;
}

// Whether the segment leads where the vehicle looks, as far as that is known.
bool leads_ahead(const RouteLine& line, double along_m, const CoarsePosition& vehicle) {
  if (!vehicle.heading_deg) return true;
  const double turn_deg = *vehicle.heading_deg - line.heading_deg_at(along_m);
  return std::abs(std::remainder(turn_deg, 360)) <= kMaxStartTurnDeg;
}

}  // namespace

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
  if (auto* following = std::get_if<Following>(&impl_->state)) {
    following->place.follower->observe(odometry);
  } else {
    auto& searching = std::get<Searching>(impl_->state);
    for (Place& place : searching.places) place.follower->observe(odometry);
    if (searching.left) searching.left->follower->observe(odometry);
  }
}

const std::optional<Error>& Localizer::noted_error() const { return impl_->noted; }

Result<Fix> Localizer::localize(const QueryFrame& frame) {
  SeenFrame seen(frame);
  return std::holds_alternative<Following>(impl_->state) ? impl_->follow(seen)
                                                         : impl_->search(seen);
}

// The position, unless it is too old to start from or to contradict.
std::optional<CoarsePosition> Localizer::Impl::fresh(const std::optional<CoarsePosition>& position,
                                                     double timestamp_s) const {
  const bool is_fresh =
      position && timestamp_s - position->timestamp_s <= settings.max_coarse_age_s;
  return is_fresh ? position : std::nullopt;
}

Result<std::shared_ptr<OpenSegment>> Localizer::Impl::opened(const NearbySegment& where) {
  for (const std::shared_ptr<OpenSegment>& segment : segments) {
    const LayerSource& layer = segment->session.layer;
    if (layer.version == where.version && layer.segment == where.segment) return segment;
  }
  Result<SegmentSession> session =
      open_session({source, where.version, where.segment, settings.method.layer});
  if (!session) return session.error();
  auto segment = std::make_shared<OpenSegment>(OpenSegment{std::move(*session), nullptr});
  Result<std::unique_ptr<Scout>> scout =
      settings.method.make_scout(segment->session, camera, settings.scout);
  if (!scout) return scout.error();
  segment->scout = std::move(*scout);
  if (segments.size() == kMaxCandidates) segments.erase(segments.begin());
  segments.push_back(segment);
  return segment;
}

// Adds the places on segments near to a position that this frame may have been taken from. How far
// the nearest segment is; infinitely, where none is near.
Result<double> Localizer::Impl::scout(SeenFrame& frame, const CoarsePosition& around,
                                      Searching& searching) {
  const double age_s = frame.timestamp_s() - around.timestamp_s;
  const double reach_m = settings.start_sigmas * around.sigma_m + settings.start_reach_m +
                         settings.receiver.speed_mps * age_s;
  const double radius_m = settings.start_radius_m + settings.start_sigmas * around.sigma_m;
  Result<std::vector<NearbySegment>> near = source->segments_near(around.position, radius_m);
  if (!near) return near.error();
  if (near->size() > kMaxCandidates) near->resize(kMaxCandidates);
  for (const NearbySegment& where : *near) {
    const Result<std::shared_ptr<OpenSegment>> segment = opened(where);
    if (!segment) return segment.error();
    if (!leads_ahead((*segment)->session.line, where.along_m, around)) continue;
    Result<std::vector<Sighting>> seen =
        (*segment)->scout->look(frame, AlongRange{where.along_m, where.along_m}.widened(reach_m));
    if (!seen) return seen.error();
    for (Sighting& sighting : *seen) {
      Place place{*segment,
                  std::move(sighting.follower),
                  PlaceOdds(settings.odds),
                  ReceiverEvidence(settings.receiver),
                  frame.timestamp_s(),
                  true,
                  sighting.log_bayes_factor,
                  sighting.matches};
      const double along_m = place.follower->position().along_m;
      if (!place.is_on_segment(along_m)) continue;
      if (searching.left) place.odds.add(log_density_after(*searching.left, place));
      if (odometry && frame.timestamp_s() - odometry->timestamp_s <= kMaxOdometryAgeS)
        place.follower->observe(*odometry);
      searching.places.push_back(std::move(place));
    }
  }
  return near->empty() ? std::numeric_limits<double>::infinity() : near->front().distance_m;
}

// Advances the places that are not at this frame yet.
void Localizer::Impl::carry(Searching& searching, SeenFrame& frame) {
  const auto is_over = [&](Place& place) {
    if (place.timestamp_s == frame.timestamp_s()) return false;
    const Followed followed = place.advance(frame);
    if (followed.failure) noted = followed.failure;
    const bool is_gone = followed.failure && followed.failure->code == ErrorCode::gone;
    const bool has_left = !place.is_on_segment(place.follower->position().along_m);
    if (has_left && searching.waiting == FixStatus::lost) searching.leave(std::move(place));
    return is_gone || has_left;
  };
  std::erase_if(searching.places, is_over);
}

Result<Fix> Localizer::Impl::search(SeenFrame& frame) {
  auto& searching = std::get<Searching>(state);
  carry(searching, frame);
  const std::optional<CoarsePosition> reading = fresh(coarse, frame.timestamp_s());
  const auto around = reading ? reading : fresh(searching.lost_at, frame.timestamp_s());
  if (around) {
    const Result<double> nearest_m = scout(frame, *around, searching);
    if (!nearest_m) {
      if (searching.places.empty()) return nearest_m.error();
      noted = nearest_m.error();
    } else if (reading && *nearest_m > settings.start_sigmas * reading->sigma_m + kEndMarginM) {
      searching.waiting = FixStatus::off_map;
    } else if (reading && searching.waiting == FixStatus::off_map && !searching.left) {
      searching.waiting = FixStatus::initializing;
    }
  }
  weigh(searching.places, reading, static_cast<std::size_t>(settings.max_places));
  return weighed(searching, frame.timestamp_s());
}

// The answer while several places may be it.
Fix Localizer::Impl::weighed(Searching& searching, double timestamp_s) {
  if (searching.places.empty()) return unlocated(timestamp_s, searching.waiting);
  Place& best = searching.places.front();
  const double log_odds = log_odds_of_first(searching.places);
  const bool was_lost = searching.waiting == FixStatus::lost;
  if (log_odds < 0 || (was_lost && !best.measured))
    return unlocated(timestamp_s, searching.waiting);
  if (log_odds < settings.odds.claim || !best.measured || best.apart_m > kAgreedM) {
    Fix fix = located(best, FixStatus::initializing);
    widen(fix, best.odds.log(), best, searching.places);
    return fix;
  }
  claim(std::move(best));
  return located(std::get<Following>(state).place, FixStatus::tracking);
}

void Localizer::Impl::claim(Place place) {
  prefetched_to_m = 0;
  state = Following{std::move(place)};
}

// Finds the pose anew, where that is due, and compares.
void Localizer::Impl::look_again(Following& following, SeenFrame& frame) const {
  Place& place = following.place;
  const double along_m = place.follower->position().along_m;
  if (!settings.method.looks_again || !following.second_look.is_due(along_m)) return;
  const AlongRange around = AlongRange{along_m, along_m}.widened(kSamePlaceM);
  Result<std::vector<Sighting>> seen = place.segment->scout->look(frame, around);
  if (seen) following.second_look.compare(place, std::move(*seen));
}

Result<Fix> Localizer::Impl::follow(SeenFrame& frame) {
  auto& following = std::get<Following>(state);
  Place& place = following.place;
  if (!place.is_on_segment(place.follower->expected_along_m(frame.timestamp_s()))) {
    Searching left;
    left.leave(std::move(place));
    state = std::move(left);
    const Result<Fix> elsewhere = search(frame);  // perhaps another segment begins here
    if (elsewhere && elsewhere->along_m) return elsewhere;
    return unlocated(frame.timestamp_s(), FixStatus::off_map);
  }
  const Followed followed = place.advance(frame);
  if (followed.failure) noted = followed.failure;
  if (followed.failure && followed.failure->code == ErrorCode::gone) {  // rebuilt meanwhile
    state = Searching{FixStatus::lost};
    return search(frame);
  }
  if (place.measured) look_again(following, frame);
  place.weigh(place.log_bayes_factor, fresh(coarse, frame.timestamp_s()));
  if (place.measured && place.odds.log() >= settings.odds.hold) {
    following.frames_without_measurement = 0;
    prefetch_ahead(place);
    return located(place, FixStatus::tracking);
  }
  const bool is_lost = ++following.frames_without_measurement > settings.max_predicted_frames ||
                       place.odds.log() < settings.odds.give_up;
  if (!is_lost) {
    Fix fix = located(place, FixStatus::predicted);
    // What speaks against the place may be a truck before it, or that it is elsewhere.
    const bool in_doubt = place.log_bayes_factor < kDoubt || place.odds.log() < settings.odds.hold;
    if (in_doubt) widen(fix, std::min(place.odds.log(), settings.odds.doubt), place, {});
    return fix;
  }
  Searching lost{FixStatus::lost};
  const double sigma_m = std::max(place.follower->position().sigma_m, kElsewhereM);
  lost.lost_at = CoarsePosition{frame.timestamp_s(), place.position(), sigma_m};
  lost.places.push_back(std::move(place));
  state = std::move(lost);
  return search(frame);
}

Fix Localizer::Impl::located(const Place& place, FixStatus status) const {
  const TrackedPosition position = place.follower->position();
  Fix fix = unlocated(place.timestamp_s, status);
  fix.version = place.session().layer.version;
  fix.segment = place.session().layer.segment;
  fix.along_m = std::clamp(position.along_m, 0.0, place.session().line.length_m());
  fix.sigma_m = std::hypot(position.sigma_m, place.apart_m);
  fix.position = place.session().line.point_at(*fix.along_m);
  if (position.across) {
    fix.lateral_m = position.across->lateral_m;
    fix.lateral_sigma_m = std::hypot(position.across->lateral_sigma_m, place.apart_m);
    fix.heading_deg = position.across->heading_deg;
    fix.position = position.across->position;
  }
  fix.matches = place.measured ? place.matches : 0;
  return fix;
}

// A place that is not certain: its sigma is that of all that it may be, about where it is said to
// be. Elsewhere is where the receiver says, as far as it knows.
void Localizer::Impl::widen(Fix& fix, double log_odds, const Place& place,
                            const std::vector<Place>& places) const {
  const GeoPoint here = place.position();
  double weights = 1 + std::exp(log_odds);
  double square_m2 = kUnknownM * kUnknownM;
  if (const auto reading = fresh(coarse, place.timestamp_s)) {
    const double sigma_m = std::max(kElsewhereM, reading->sigma_m);
    square_m2 = sigma_m * sigma_m + std::pow(geodesic_distance_m(here, reading->position), 2);
  }
  for (const Place& other : places) {
    if (&other == &place) continue;
    const double weight = std::exp(other.odds.log());
    weights += weight;
    square_m2 += weight * std::pow(geodesic_distance_m(here, other.position()), 2);
  }
  const double spread_m = std::sqrt(square_m2 / weights);
  fix.sigma_m = std::hypot(fix.sigma_m, spread_m);
  if (fix.lateral_sigma_m) fix.lateral_sigma_m = std::hypot(*fix.lateral_sigma_m, spread_m);
}

void Localizer::Impl::prefetch_ahead(const Place& place) {
  if (!prefetcher) return;
  const double at_m = place.follower->position().along_m;
  if (at_m + settings.prefetch_m / 2 < prefetched_to_m) return;
  const AlongRange ahead = {at_m, at_m + settings.prefetch_m};
  const SegmentSession& session = place.session();
  if (prefetched_to_m < session.line.length_m()) {
    prefetcher->request(session.layer.version, session.layer.segment, settings.method.layer, ahead);
  }
  prefetched_to_m = ahead.to_m;
}

}  // namespace milepost
