#include "client/localize/localizer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include "client/localize/branches.h"
#include "client/localize/hypothesis.h"
#include "client/localize/hypothesis_fix.h"
#include "client/localize/nearby_search.h"
#include "client/localize/relocalization_check.h"
#include "client/localize/wanted_map.h"

namespace milepost {
namespace {

constexpr double kMaxOdometryAgeS = 0.5;  // of a reading used when a hypothesis starts
constexpr double kLeftSigmaM = 1;         // minimum sigma of a hypothesis that left the map
constexpr double kDoubt = -1;             // log Bayes factor of a frame that causes doubt

// No hypothesis is accepted: all are tested against each other and elsewhere.
struct Searching {
  // The status reported until one is accepted: initializing, lost, off_map.
  FixStatus waiting = FixStatus::initializing;
  std::vector<Hypothesis> hypotheses = {};
  std::optional<GnssFix> lost_at = {};      // position of the hypothesis, or branch, tracked last
  std::optional<Hypothesis> left = {};      // a hypothesis that left the map
  std::optional<Hypothesis> given_up = {};  // ... that was tracked until it was lost

  void leave(Hypothesis hypothesis) {
    waiting = FixStatus::off_map;
    left = std::move(hypothesis);
  }
};

// One hypothesis is accepted and tracked.
struct Tracking {
  Hypothesis hypothesis;
  int frames_without_measurement = 0;
  RelocalizationCheck relocalization_check = {};
  // Log odds of the hypothesis if the latest frame left it in doubt.
  std::optional<double> doubt = {};
};

}  // namespace

struct Localizer::Impl {
  Impl(const std::shared_ptr<MapSource>& source, const Camera& query,
       const LocalizerSettings& given)
      : settings(given),
        provider(source, given.method.layer, given.provider),
        nearby(given, query) {}

  LocalizerSettings settings;
  TileProvider provider;
  NearbySearch nearby;

  std::optional<GnssFix> gnss;       // the latest
  std::optional<Odometry> odometry;  // the latest
  ExpectedRoute route;
  std::variant<Searching, Tracking> state = Searching{};
  std::optional<Error> last_error;

  Result<Fix> search(SharedFrame& frame);
  Result<Fix> track(SharedFrame& frame);
  Result<Fix> leave(SharedFrame& frame);

  std::optional<GnssFix> fresh(const std::optional<GnssFix>& position, double timestamp_s) const;
  FoundNearby search_around(SharedFrame& frame, const GnssFix& around, Searching& searching);
  double log_bayes_factor_of_return(const Searching& searching, const Hypothesis& found) const;
  void carry(Searching& searching, SharedFrame& frame);
  Fix weighed(Searching& searching, double timestamp_s);
  Fix unclaimed(const Searching& searching, double timestamp_s) const;
  Fix carried_fix(const Hypothesis& hypothesis, double timestamp_s) const;
  void check_by_relocalization(Tracking& tracking, SharedFrame& frame);
  void claim(Hypothesis hypothesis);
  Wants wants(double timestamp_s, const HeldMap& held) const;
  void widen(Fix& fix, double log_odds, const Hypothesis& hypothesis,
             const std::vector<Hypothesis>& hypotheses = {}) const;
};

namespace {

GnssFix place_of(const Hypothesis& hypothesis, double timestamp_s) {
  const double sigma_m = std::max(hypothesis.tracker->pose().sigma_m, kElsewhereM);
  return {timestamp_s, hypothesis.position(), sigma_m};
}

Searching lost_from(const Hypothesis& hypothesis, double timestamp_s) {
  Searching lost{FixStatus::lost};
  lost.lost_at = place_of(hypothesis, timestamp_s);
  return lost;
}

Searching at_a_junction(std::vector<Hypothesis> branches, double timestamp_s) {
  Searching searching{FixStatus::initializing, std::move(branches)};
  searching.lost_at = place_of(searching.hypotheses.front(), timestamp_s);
  return searching;
}

// Whether the hypothesis' segment ends within `ahead_m`.
bool is_near_end(const Hypothesis& hypothesis, double ahead_m) {
  return hypothesis.tracker->pose().along_m + ahead_m > hypothesis.layer().line.length_m();
}

// Where a hypothesis is now by its motion, while that is known well enough.
std::optional<GnssFix> carried_to(const Hypothesis& hypothesis, double timestamp_s,
                                  double min_sigma_m) {
  const TrackedPose pose = hypothesis.tracker->pose_at(timestamp_s);
  if (!pose.full) return std::nullopt;
  const double sigma_m = pose.full->camera.sigma_in_plan_m();
  if (sigma_m > kUnknownM) return std::nullopt;
  return GnssFix{timestamp_s, pose.full->camera.position, std::max(sigma_m, min_sigma_m)};
}

std::optional<GnssFix> left_at(const Searching& searching, double timestamp_s) {
  if (!searching.left) return std::nullopt;
  return carried_to(*searching.left, timestamp_s, kLeftSigmaM);
}

// The rejected hypothesis that its motion carries on; null if there is none.
const Hypothesis* carried_of(const Searching& searching, double timestamp_s) {
  const auto carried = std::ranges::find_if(searching.hypotheses, [&](const Hypothesis& each) {
    return each.is_carried(each.tracker->pose_at(timestamp_s));
  });
  return carried == searching.hypotheses.end() ? nullptr : &*carried;
}

// The place to search without a receiver.
std::optional<GnssFix> carried_place(const Searching& searching, double timestamp_s) {
  if (const auto left = left_at(searching, timestamp_s)) return left;
  if (const Hypothesis* carried = carried_of(searching, timestamp_s))
    return carried_to(*carried, timestamp_s, kElsewhereM);
  if (!searching.given_up) return std::nullopt;
  return carried_to(*searching.given_up, timestamp_s, kElsewhereM);
}

}  // namespace

Localizer::Localizer(const std::shared_ptr<MapSource>& source, const Camera& camera,
                     const LocalizerSettings& settings)
    : impl_(std::make_unique<Impl>(source, camera, settings)) {}

Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::observe(const GnssFix& position) {
  impl_->gnss = position;
  impl_->provider.want(impl_->wants(position.timestamp_s, *impl_->provider.held()));
}

void Localizer::observe(const Odometry& odometry) {
  const bool is_sound = std::isfinite(odometry.speed_mps) && std::isfinite(odometry.yaw_rate_dps);
  const bool ascends = !impl_->odometry || odometry.timestamp_s > impl_->odometry->timestamp_s;
  if (!is_sound || !ascends) return;
  impl_->odometry = odometry;
  if (auto* tracking = std::get_if<Tracking>(&impl_->state)) {
    tracking->hypothesis.tracker->observe(odometry);
  } else {
    auto& searching = std::get<Searching>(impl_->state);
    for (Hypothesis& hypothesis : searching.hypotheses) hypothesis.tracker->observe(odometry);
    for (auto* carried : {&searching.left, &searching.given_up}) {
      if (*carried) (*carried)->tracker->observe(odometry);
    }
  }
}

void Localizer::expect(ExpectedRoute route) { impl_->route = std::move(route); }

const std::optional<Error>& Localizer::last_error() const { return impl_->last_error; }

Result<Fix> Localizer::localize(const QueryFrame& frame) {
  const std::shared_ptr<const HeldMap> held = impl_->provider.held();
  SharedFrame shared(frame, *held);
  Result<Fix> fix =
      std::holds_alternative<Tracking>(impl_->state) ? impl_->track(shared) : impl_->search(shared);
  impl_->provider.want(impl_->wants(frame.timestamp_s, *held));
  return fix;
}

Fix Localizer::fix_at(double timestamp_s) const {
  const auto* tracking = std::get_if<Tracking>(&impl_->state);
  if (!tracking) return impl_->unclaimed(std::get<Searching>(impl_->state), timestamp_s);
  const Hypothesis& hypothesis = tracking->hypothesis;
  const TrackedPose position = hypothesis.tracker->pose_at(timestamp_s);
  const bool is_on_map =
      hypothesis.is_on_segment(position) || leads_on(hypothesis, position, *impl_->provider.held());
  if (!is_on_map) return unlocated(timestamp_s, FixStatus::off_map);
  Fix fix = fix_of(hypothesis, position, timestamp_s, FixStatus::predicted);
  if (tracking->doubt) impl_->widen(fix, *tracking->doubt, hypothesis);
  return fix;
}

const TileProvider& Localizer::provider() const { return impl_->provider; }

bool Localizer::wait_for_tiles(double timestamp_s, SteadyTime deadline, const Stopped& stopped) {
  TileProvider& provider = impl_->provider;
  constexpr std::chrono::milliseconds kBetweenQuestions(50);
  for (;;) {
    const std::shared_ptr<const HeldMap> held = provider.held();
    provider.want(impl_->wants(timestamp_s, *held));
    // Data that has arrived may have led to further wants.
    if (provider.is_settled() && provider.held() == held) return true;
    const SteadyTime now = std::chrono::steady_clock::now();
    if (is_stopped(stopped) || now >= deadline) return false;
    provider.wait_for_change(held, std::min(deadline, now + kBetweenQuestions));
  }
}

// Of the motion since a hypothesis left the map, for one that is found. Next to a GNSS fix, which
// already speaks for the place, only what speaks against it counts.
double Localizer::Impl::log_bayes_factor_of_return(const Searching& searching,
                                                   const Hypothesis& found) const {
  if (!searching.left) return 0;
  const double log_bayes_factor = log_bayes_factor_after(*searching.left, found);
  const bool is_known_otherwise =
      fresh(gnss, found.timestamp_s).has_value() || !left_at(searching, found.timestamp_s);
  return is_known_otherwise ? std::min(log_bayes_factor, 0.0) : log_bayes_factor;
}

// The fix, unless it is too old to start from or to contradict.
std::optional<GnssFix> Localizer::Impl::fresh(const std::optional<GnssFix>& position,
                                              double timestamp_s) const {
  const bool is_fresh = position && timestamp_s - position->timestamp_s <= settings.max_gnss_age_s;
  return is_fresh ? position : std::nullopt;
}

// Adds hypotheses on segments near a position from which this frame may have been taken.
FoundNearby Localizer::Impl::search_around(SharedFrame& frame, const GnssFix& around,
                                           Searching& searching) {
  FoundNearby found = nearby.search(frame, around);
  for (Hypothesis& hypothesis : found.hypotheses) {
    hypothesis.odds.add(log_bayes_factor_of_return(searching, hypothesis));
    if (odometry && frame.timestamp_s() - odometry->timestamp_s <= kMaxOdometryAgeS)
      hypothesis.tracker->observe(*odometry);
    searching.hypotheses.push_back(std::move(hypothesis));
  }
  found.hypotheses.clear();
  return found;
}

// Advances the hypotheses that are not at this frame yet.
void Localizer::Impl::carry(Searching& searching, SharedFrame& frame) {
  std::vector<Hypothesis> branches;
  std::erase_if(searching.hypotheses, [&](const Hypothesis& hypothesis) {
    auto found =
        branches_of(hypothesis, hypothesis.tracker->pose_at(frame.timestamp_s()), frame.held());
    std::ranges::move(found, std::back_inserter(branches));
    return !found.empty();
  });
  std::ranges::move(branches, std::back_inserter(searching.hypotheses));
  const auto is_over = [&](Hypothesis& hypothesis) {
    if (hypothesis.timestamp_s == frame.timestamp_s()) return false;
    const TrackingResult result = hypothesis.advance(frame);
    if (result.failure) last_error = result.failure;
    const bool is_gone = result.failure && result.failure->code == ErrorCode::gone;
    const bool has_left = !hypothesis.is_on_segment(hypothesis.tracker->pose());
    if (has_left && searching.waiting == FixStatus::lost) searching.leave(std::move(hypothesis));
    return is_gone || has_left;
  };
  std::erase_if(searching.hypotheses, is_over);
}

Result<Fix> Localizer::Impl::search(SharedFrame& frame) {
  auto& searching = std::get<Searching>(state);
  carry(searching, frame);
  const std::optional<GnssFix> reading = fresh(gnss, frame.timestamp_s());
  std::optional<GnssFix> around = reading;
  const bool is_tested = searching.waiting != FixStatus::lost && !searching.hypotheses.empty();
  if (!around && !is_tested) around = fresh(searching.lost_at, frame.timestamp_s());
  if (!around) around = carried_place(searching, frame.timestamp_s());
  if (around) {
    const FoundNearby found = search_around(frame, *around, searching);
    if (found.failure) {
      if (searching.hypotheses.empty()) return *found.failure;
      last_error = found.failure;
    }
    if (reading && found.nearest_m) {
      const bool is_off = *found.nearest_m > settings.start_sigmas * reading->sigma_m + kEndMarginM;
      if (is_off) {
        searching.waiting = FixStatus::off_map;
      } else if (searching.waiting == FixStatus::off_map && !searching.left) {
        searching.waiting = FixStatus::initializing;
      }
    }
  }
  std::vector<Hypothesis> dropped =
      weigh(searching.hypotheses, reading, static_cast<std::size_t>(settings.max_hypotheses));
  for (Hypothesis& hypothesis : dropped) {
    if (hypothesis.was_tracked) searching.given_up = std::move(hypothesis);
  }
  const bool are_branches = searching.lost_at && searching.waiting == FixStatus::initializing;
  if (are_branches && !searching.hypotheses.empty())
    searching.lost_at = place_of(searching.hypotheses.front(), frame.timestamp_s());
  return weighed(searching, frame.timestamp_s());
}

// The result while several hypotheses are tested.
Fix Localizer::Impl::weighed(Searching& searching, double timestamp_s) {
  if (searching.hypotheses.empty()) return unclaimed(searching, timestamp_s);
  Hypothesis& best = searching.hypotheses.front();
  const double log_odds = log_odds_of_first(searching.hypotheses);
  const bool was_lost = searching.waiting == FixStatus::lost;
  if (log_odds < 0 || (was_lost && !best.measured)) return unclaimed(searching, timestamp_s);
  if (log_odds < settings.odds.claim || !best.measured || best.apart_m > kAgreedM) {
    Fix fix = fix_of(best, FixStatus::initializing);
    widen(fix, best.odds.log(), best, searching.hypotheses);
    return fix;
  }
  claim(std::move(best));
  return fix_of(std::get<Tracking>(state).hypothesis, FixStatus::tracking);
}

// The result without any hypothesis to tell: off the map, and after the one that was tracked was
// rejected, the pose that the motion carries on.
Fix Localizer::Impl::unclaimed(const Searching& searching, double timestamp_s) const {
  if (const Hypothesis* carried = carried_of(searching, timestamp_s))
    return carried_fix(*carried, timestamp_s);
  Fix fix = unlocated(timestamp_s, searching.waiting);
  if (searching.waiting != FixStatus::off_map || !left_at(searching, timestamp_s)) return fix;
  carry_on(fix, *searching.left, timestamp_s);
  return fix;
}

// Frames contradict the hypothesis, or show nothing: it may as well be elsewhere.
Fix Localizer::Impl::carried_fix(const Hypothesis& hypothesis, double timestamp_s) const {
  Fix fix = fix_of(hypothesis, hypothesis.tracker->pose_at(timestamp_s), timestamp_s,
                   FixStatus::predicted);
  widen(fix, std::min(hypothesis.odds.log(), settings.odds.doubt), hypothesis);
  return fix;
}

void Localizer::Impl::claim(Hypothesis hypothesis) { state = Tracking{std::move(hypothesis)}; }

// Relocalizes and compares the poses, if that is due.
void Localizer::Impl::check_by_relocalization(Tracking& tracking, SharedFrame& frame) {
  Hypothesis& hypothesis = tracking.hypothesis;
  const double along_m = hypothesis.tracker->pose().along_m;
  const bool is_due = settings.method.relocalizes_while_tracking &&
                      tracking.relocalization_check.is_due(hypothesis.way_m());
  if (!is_due) return;
  const AlongRange around = AlongRange{along_m, along_m}.widened(kSameHypothesisM);
  const Result<Relocalizer*> relocalizer = nearby.relocalizer_on(hypothesis.tracker->layer());
  if (!relocalizer) return;
  Relocalization found =
      (*relocalizer)->relocalize(frame, around, tracking.relocalization_check.camera(hypothesis));
  if (!found.failure)
    tracking.relocalization_check.compare(hypothesis, std::move(found.candidates));
}

// The tracked hypothesis has left the map, or its segment: another may begin here.
Result<Fix> Localizer::Impl::leave(SharedFrame& frame) {
  Searching left;
  left.leave(std::move(std::get<Tracking>(state).hypothesis));
  state = std::move(left);
  const Result<Fix> elsewhere = search(frame);
  if (elsewhere && elsewhere->along_m) return elsewhere;
  return unclaimed(std::get<Searching>(state), frame.timestamp_s());
}

Result<Fix> Localizer::Impl::track(SharedFrame& frame) {
  auto& tracking = std::get<Tracking>(state);
  Hypothesis& hypothesis = tracking.hypothesis;
  const TrackedPose expected = hypothesis.tracker->pose_at(frame.timestamp_s());
  if (std::vector<Hypothesis> branches = branches_of(hypothesis, expected, frame.held());
      !branches.empty()) {
    if (branches.size() > 1) {
      state = at_a_junction(std::move(branches), frame.timestamp_s());
      return search(frame);
    }
    hypothesis = std::move(branches.front());
  } else if (!hypothesis.is_on_segment(expected) && !leads_on(hypothesis, expected, frame.held())) {
    return leave(frame);
  }
  const TrackingResult result = hypothesis.advance(frame);
  if (result.failure) last_error = result.failure;
  if (result.failure && result.failure->code == ErrorCode::gone) {  // the map was rebuilt
    state = lost_from(hypothesis, frame.timestamp_s());
    return search(frame);
  }
  if (!is_on_road(hypothesis.tracker->pose())) return leave(frame);
  tracking.doubt.reset();
  if (hypothesis.measured) check_by_relocalization(tracking, frame);
  hypothesis.weigh(hypothesis.log_bayes_factor, fresh(gnss, frame.timestamp_s()));
  tracking.frames_without_measurement =
      hypothesis.measured ? 0 : tracking.frames_without_measurement + 1;
  if (hypothesis.measured && hypothesis.odds.log() >= settings.odds.hold)
    return fix_of(hypothesis, FixStatus::tracking);
  const bool is_lost = tracking.frames_without_measurement > settings.max_predicted_frames ||
                       hypothesis.odds.log() < settings.odds.give_up;
  if (!is_lost) {
    Fix fix = fix_of(hypothesis, FixStatus::predicted);
    // The contradiction may be an occlusion, or the vehicle may be elsewhere.
    const bool in_doubt = hypothesis.contradicted || hypothesis.log_bayes_factor < kDoubt ||
                          hypothesis.odds.log() < settings.odds.hold;
    if (in_doubt) tracking.doubt = std::min(hypothesis.odds.log(), settings.odds.doubt);
    if (tracking.doubt) widen(fix, *tracking.doubt, hypothesis);
    return fix;
  }
  Searching lost = lost_from(hypothesis, frame.timestamp_s());
  hypothesis.was_tracked = true;
  lost.hypotheses.push_back(std::move(hypothesis));
  state = std::move(lost);
  return search(frame);
}

void Localizer::Impl::widen(Fix& fix, double log_odds, const Hypothesis& hypothesis,
                            const std::vector<Hypothesis>& hypotheses) const {
  milepost::widen(fix, log_odds, hypothesis, hypotheses, fresh(gnss, hypothesis.timestamp_s));
}

// The map data that a frame at that time, and those after it, need.
Wants Localizer::Impl::wants(double timestamp_s, const HeldMap& held) const {
  const WindowReach& reach = settings.method_settings.reach;
  WantedMap wanted(held, route);
  const auto want_place = [&](const Hypothesis& hypothesis) {
    // The region tracked, plus the region of relocalization.
    constexpr double kSecondLookM = kSameHypothesisM + 10;
    const AlongRange needed = hypothesis.tracker->needed(timestamp_s).widened(kSecondLookM);
    wanted.add_way(hypothesis.tracker->layer(), reach.around(needed), WantedFor::this_frame);
  };
  std::optional<GnssFix> around = fresh(gnss, timestamp_s);
  const auto* tracking = std::get_if<Tracking>(&state);
  if (tracking) {
    const Hypothesis& tracked = tracking->hypothesis;
    want_place(tracked);
    const double at_m = tracked.tracker->pose().along_m;
    wanted.add_way(tracked.tracker->layer(), {at_m, at_m + settings.prefetch_m},
                   WantedFor::the_way_ahead);
    if (!around) around = GnssFix{timestamp_s, tracked.position(), 0};
  } else {
    const auto& searching = std::get<Searching>(state);
    for (const Hypothesis& hypothesis : searching.hypotheses) want_place(hypothesis);
    if (!around) around = fresh(searching.lost_at, timestamp_s);
    if (!around) around = carried_place(searching, timestamp_s);
  }
  if (!around) return wanted.wants();
  wanted.set_surroundings(nearby.surroundings(*around));
  const auto segments = nearby.segments(held, *around);
  if (!segments) return wanted.wants();
  for (const NearbySegment& where : *segments) {
    const SegmentKey key = {where.version, where.segment};
    // Segments on which the vehicle may be relocalized; other segments near the end of this one.
    const bool is_of_use = !tracking || key == tracking->hypothesis.layer().key ||
                           is_near_end(tracking->hypothesis, settings.prefetch_m);
    if (!is_of_use) continue;
    wanted.add(key, reach.around(nearby.range(where.along_m, *around, timestamp_s)),
               tracking ? WantedFor::a_restart : WantedFor::this_frame);
  }
  return wanted.wants();
}

}  // namespace milepost
