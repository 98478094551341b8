#include "client/localize/localizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "client/fetch/tile_provider.h"
#include "client/localize/place.h"
#include "client/localize/second_look.h"
#include "schema/geo/near.h"

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
  std::optional<double> doubt =
      {};  // log odds of the place, where the latest frame left it in doubt
};

// What a look about a position came to.
struct Scouted {
  std::optional<double> nearest_m;  // how far the nearest segment is, infinitely where none is
                                    // near; nothing while that is not known
  std::optional<Error> failure = std::nullopt;  // why something is missing of the map
};

}  // namespace

struct Localizer::Impl {
  Impl(const std::shared_ptr<MapSource>& source, const Camera& query,
       const LocalizerSettings& given)
      : camera(query), settings(given), provider(source, given.method.layer, given.provider) {}

  Camera camera;
  LocalizerSettings settings;
  TileProvider provider;

  std::optional<CoarsePosition> coarse;  // the receiver's latest
  std::optional<Odometry> odometry;      // the latest
  std::variant<Searching, Following> state = Searching{};
  std::vector<std::shared_ptr<OpenSegment>> segments;  // opened last, the latest at the end
  std::optional<Error> noted;

  Result<Fix> search(SeenFrame& frame);
  Result<Fix> follow(SeenFrame& frame);

  std::optional<CoarsePosition> fresh(const std::optional<CoarsePosition>& position,
                                      double timestamp_s) const;
  Surroundings surroundings(const CoarsePosition& around) const;
  double start_reach_m(const CoarsePosition& around, double timestamp_s) const;
  Scouted scout(SeenFrame& frame, const CoarsePosition& around, Searching& searching);
  Result<std::shared_ptr<OpenSegment>> opened(const std::shared_ptr<const SegmentLayer>& layer);
  void carry(Searching& searching, SeenFrame& frame);
  Fix weighed(Searching& searching, double timestamp_s);
  void look_again(Following& following, SeenFrame& frame) const;
  void claim(Place place);
  Wants wants(double timestamp_s, const HeldMap& held) const;
  Fix located(const Place& place, FixStatus status) const;
  Fix located(const Place& place, const TrackedPosition& position, double timestamp_s,
              FixStatus status) const;
  void widen(Fix& fix, double log_odds, const Place& place, const std::vector<Place>& places) const;
};

namespace {

Fix unlocated(double timestamp_s, FixStatus status) {
  Fix fix;
  fix.timestamp_s = timestamp_s;
  fix.status = status;
  return fix;
}

Searching lost_from(const Place& place, double timestamp_s) {
  Searching lost{FixStatus::lost};
  const double sigma_m = std::max(place.follower->position().sigma_m, kElsewhereM);
  lost.lost_at = CoarsePosition{timestamp_s, place.position(), sigma_m};
  return lost;
}

// Adds a variance that is alike in each direction of the plan.
void widen_in_plan(CameraPlacement& camera, double sigma_m) {
  camera.covariance[0] += sigma_m * sigma_m;
  camera.covariance[7] += sigma_m * sigma_m;
}

// Whether the segment leads where the vehicle looks, as far as that is known.
bool leads_ahead(const RouteLine& line, double along_m, const CoarsePosition& vehicle) {
  if (!vehicle.heading_deg) return true;
  const double turn_deg = *vehicle.heading_deg - line.heading_deg_at(along_m);
  return std::abs(std::remainder(turn_deg, 360)) <= kMaxStartTurnDeg;
}

}  // namespace

Localizer::Localizer(const std::shared_ptr<MapSource>& source, const Camera& camera,
                     const LocalizerSettings& settings)
    : impl_(std::make_unique<Impl>(source, camera, settings)) {}

Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::observe(const CoarsePosition& position) {
  impl_->coarse = position;
  impl_->provider.want(impl_->wants(position.timestamp_s, *impl_->provider.held()));
}

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
  const std::shared_ptr<const HeldMap> held = impl_->provider.held();
  SeenFrame seen(frame, *held);
  Result<Fix> fix =
      std::holds_alternative<Following>(impl_->state) ? impl_->follow(seen) : impl_->search(seen);
  impl_->provider.want(impl_->wants(frame.timestamp_s, *held));
  return fix;
}

Fix Localizer::fix_at(double timestamp_s) const {
  const auto* following = std::get_if<Following>(&impl_->state);
  if (!following) {
    return unlocated(timestamp_s, std::get<Searching>(impl_->state).waiting);
  }
  const Place& place = following->place;
  const TrackedPosition position = place.follower->position_at(timestamp_s);
  if (!place.is_on_segment(position.along_m)) return unlocated(timestamp_s, FixStatus::off_map);
  Fix fix = impl_->located(place, position, timestamp_s, FixStatus::predicted);
  if (following->doubt) impl_->widen(fix, *following->doubt, place, {});
  return fix;
}

const TileProvider& Localizer::provider() const { return impl_->provider; }

bool Localizer::wait_for_tiles(double timestamp_s, SteadyTime deadline, const Stopped& stopped) {
  TileProvider& provider = impl_->provider;
  constexpr std::chrono::milliseconds kBetweenQuestions(50);
  for (;;) {
    const std::shared_ptr<const HeldMap> held = provider.held();
    provider.want(impl_->wants(timestamp_s, *held));
    // What is held may have told of more to want.
    if (provider.is_settled() && provider.held() == held) return true;
    const SteadyTime now = std::chrono::steady_clock::now();
    if (is_stopped(stopped) || now >= deadline) return false;
    provider.wait_for_change(held, std::min(deadline, now + kBetweenQuestions));
  }
}

// The position, unless it is too old to start from or to contradict.
std::optional<CoarsePosition> Localizer::Impl::fresh(const std::optional<CoarsePosition>& position,
                                                     double timestamp_s) const {
  const bool is_fresh =
      position && timestamp_s - position->timestamp_s <= settings.max_coarse_age_s;
  return is_fresh ? position : std::nullopt;
}

Result<std::shared_ptr<OpenSegment>> Localizer::Impl::opened(
    const std::shared_ptr<const SegmentLayer>& layer) {
  for (const std::shared_ptr<OpenSegment>& segment : segments) {
    if (segment->layer == layer) return segment;
  }
  Result<std::unique_ptr<Scout>> scout = settings.method.make_scout(*layer, camera, settings.scout);
  if (!scout) return scout.error();
  auto segment = std::make_shared<OpenSegment>(OpenSegment{layer, std::move(*scout)});
  // Those that no place is on are forgotten, the oldest first.
  const auto unused =
      std::ranges::find_if(segments, [](const auto& old) { return old.use_count() == 1; });
  if (segments.size() >= kMaxCandidates && unused != segments.end()) segments.erase(unused);
  segments.push_back(segment);
  return segment;
}

// Segments that pass nearer may be the one that a position is on.
Surroundings Localizer::Impl::surroundings(const CoarsePosition& around) const {
  const double radius_m = settings.start_radius_m + settings.start_sigmas * around.sigma_m;
  return {around.position,
          std::min(radius_m, kMaxNearRadiusM - settings.provider.surroundings_margin_m)};
}

// How far to either side of a position it is looked for the camera.
double Localizer::Impl::start_reach_m(const CoarsePosition& around, double timestamp_s) const {
  const double age_s = std::max(0.0, timestamp_s - around.timestamp_s);
  return settings.start_sigmas * around.sigma_m + settings.start_reach_m +
         settings.receiver.speed_mps * age_s;
}

// Adds the places on segments near to a position that this frame may have been taken from.
Scouted Localizer::Impl::scout(SeenFrame& frame, const CoarsePosition& around,
                               Searching& searching) {
  auto near = frame.held().segments_near(surroundings(around));
  if (!near) return {std::nullopt, frame.held().around_failure};
  Scouted scouted;
  scouted.nearest_m =
      near->empty() ? std::numeric_limits<double>::infinity() : near->front().distance_m;
  if (near->size() > kMaxCandidates) near->resize(kMaxCandidates);
  for (const NearbySegment& where : *near) {
    const HeldSegment* held = frame.held().find({where.version, where.segment});
    if (held == nullptr || !held->layer) {
      if (held != nullptr && held->failure) scouted.failure = held->failure;
      continue;
    }
    if (!leads_ahead(held->layer->line, where.along_m, around)) continue;
    const Result<std::shared_ptr<OpenSegment>> segment = opened(held->layer);
    if (!segment) {
      scouted.failure = segment.error();
      continue;
    }
    const double reach_m = start_reach_m(around, frame.timestamp_s());
    Looked looked = (*segment)->scout->look(
        frame, AlongRange{where.along_m, where.along_m}.widened(reach_m), std::nullopt);
    if (looked.failure) scouted.failure = looked.failure;
    for (Sighting& sighting : looked.sightings) {
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
  return scouted;
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
    const Scouted scouted = scout(frame, *around, searching);
    if (scouted.failure) {
      if (searching.places.empty()) return *scouted.failure;
      noted = scouted.failure;
    }
    if (reading && scouted.nearest_m) {
      const bool is_off =
          *scouted.nearest_m > settings.start_sigmas * reading->sigma_m + kEndMarginM;
      if (is_off) {
        searching.waiting = FixStatus::off_map;
      } else if (searching.waiting == FixStatus::off_map && !searching.left) {
        searching.waiting = FixStatus::initializing;
      }
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

void Localizer::Impl::claim(Place place) { state = Following{std::move(place)}; }

// Finds the pose anew, where that is due, and compares.
void Localizer::Impl::look_again(Following& following, SeenFrame& frame) const {
  Place& place = following.place;
  const double along_m = place.follower->position().along_m;
  if (!settings.method.looks_again || !following.second_look.is_due(along_m)) return;
  const AlongRange around = AlongRange{along_m, along_m}.widened(kSamePlaceM);
  Looked looked = place.segment->scout->look(frame, around, following.second_look.camera(place));
  if (!looked.failure) following.second_look.compare(place, std::move(looked.sightings));
}

Result<Fix> Localizer::Impl::follow(SeenFrame& frame) {
  auto& following = std::get<Following>(state);
  Place& place = following.place;
  if (!place.is_on_segment(place.follower->position_at(frame.timestamp_s()).along_m)) {
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
    state = lost_from(place, frame.timestamp_s());
    return search(frame);
  }
  following.doubt.reset();
  if (place.measured) look_again(following, frame);
  place.weigh(place.log_bayes_factor, fresh(coarse, frame.timestamp_s()));
  if (place.measured && place.odds.log() >= settings.odds.hold) {
    following.frames_without_measurement = 0;
    return located(place, FixStatus::tracking);
  }
  const bool is_lost = ++following.frames_without_measurement > settings.max_predicted_frames ||
                       place.odds.log() < settings.odds.give_up;
  if (!is_lost) {
    Fix fix = located(place, FixStatus::predicted);
    // What speaks against the place may be a truck before it, or that it is elsewhere.
    const bool in_doubt = place.log_bayes_factor < kDoubt || place.odds.log() < settings.odds.hold;
    if (in_doubt) following.doubt = std::min(place.odds.log(), settings.odds.doubt);
    if (following.doubt) widen(fix, *following.doubt, place, {});
    return fix;
  }
  Searching lost = lost_from(place, frame.timestamp_s());
  lost.places.push_back(std::move(place));
  state = std::move(lost);
  return search(frame);
}

Fix Localizer::Impl::located(const Place& place, FixStatus status) const {
  Fix fix = located(place, place.follower->position(), place.timestamp_s, status);
  fix.matches = place.measured ? place.matches : 0;
  return fix;
}

Fix Localizer::Impl::located(const Place& place, const TrackedPosition& position,
                             double timestamp_s, FixStatus status) const {
  const RouteLine& line = place.layer().line;
  Fix fix = unlocated(timestamp_s, status);
  fix.version = place.layer().key.version;
  fix.segment = place.layer().key.segment;
  fix.along_m = std::clamp(position.along_m, 0.0, line.length_m());
  fix.sigma_m = std::hypot(position.sigma_m, place.apart_m);
  fix.position = line.point_at(*fix.along_m);
  if (position.across) {
    fix.lateral_m = position.across->lateral_m;
    fix.lateral_sigma_m = std::hypot(position.across->lateral_sigma_m, place.apart_m);
    fix.camera = position.across->camera;
    widen_in_plan(*fix.camera, place.apart_m);
    fix.heading_deg = fix.camera->heading_deg;
    fix.position = fix.camera->position;
  }
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
  if (fix.camera) widen_in_plan(*fix.camera, spread_m);
}

// What a frame of that time, and those after it, need of the map.
Wants Localizer::Impl::wants(double timestamp_s, const HeldMap& held) const {
  enum : int { kNow, kPerhaps, kAhead };
  const WindowReach& reach = settings.scout.reach;
  Wants wants;
  const auto want = [&](const SegmentKey& key, const AlongRange& range, int priority) {
    wants.tiles.push_back({key, range, priority});
  };
  const auto want_place = [&](const Place& place) {
    // Beside what is followed, what is looked at anew.
    constexpr double kSecondLookM = kSamePlaceM + 10;
    const AlongRange needed = place.follower->needed(timestamp_s).widened(kSecondLookM);
    want(place.layer().key, reach.around(needed), kNow);
  };
  std::optional<CoarsePosition> around = fresh(coarse, timestamp_s);
  const auto* following = std::get_if<Following>(&state);
  if (following) {
    want_place(following->place);
    const double at_m = following->place.follower->position().along_m;
    want(following->place.layer().key, {at_m, at_m + settings.prefetch_m}, kAhead);
    if (!around) around = CoarsePosition{timestamp_s, following->place.position(), 0};
  } else {
    const auto& searching = std::get<Searching>(state);
    for (const Place& place : searching.places) want_place(place);
    if (!around) around = fresh(searching.lost_at, timestamp_s);
  }
  if (!around) return wants;
  wants.around = surroundings(*around);
  auto near = held.segments_near(*wants.around);
  if (!near) return wants;
  if (near->size() > kMaxCandidates) near->resize(kMaxCandidates);
  for (const NearbySegment& where : *near) {
    const SegmentKey key = {where.version, where.segment};
    // Where the place may be found again; other segments where this one ends.
    const bool is_of_use = !following || key == following->place.layer().key ||
                           following->place.is_near_end(settings.prefetch_m);
    if (!is_of_use) continue;
    const AlongRange looked_at =
        AlongRange{where.along_m, where.along_m}.widened(start_reach_m(*around, timestamp_s));
    want(key, reach.around(looked_at), following ? kPerhaps : kNow);
  }
  return wants;
}

}  // namespace milepost
