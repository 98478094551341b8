#include "client/localize/place.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace milepost {
namespace {

constexpr double kMinLogOdds = -4;  // below which a place is not pursued
constexpr double kRivalPart = 0.6;  // of the best pose's matches, from which another is its rival

// Whether two places are the same, as far as they know.
bool is_same_place(const Place& a, const Place& b) {
  return a.layer().key == b.layer().key &&
         std::abs(a.follower->position().along_m - b.follower->position().along_m) < kSamePlaceM;
}

// Of places that are one, the pose that most of the frame agrees with, with the odds of the
// likeliest and what the frame says for any of them.
void merge_same(std::vector<Place>& places) {
  std::ranges::stable_sort(places, std::greater<>(), &Place::matches);
  std::vector<Place> merged;
  for (Place& place : places) {
    const auto same = std::ranges::find_if(
        merged, [&](const Place& other) { return is_same_place(place, other); });
    if (same == merged.end()) {
      merged.push_back(std::move(place));
      continue;
    }
    if (place.matches >= kRivalPart * same->matches) {
      const double apart_m = geodesic_distance_m(place.position(), same->position());
      same->apart_m = std::max(same->apart_m, apart_m);
    }
    same->log_bayes_factor = std::max(same->log_bayes_factor, place.log_bayes_factor);
    if (place.odds.log() > same->odds.log()) {
      same->odds = place.odds;
      same->receiver = place.receiver;
    }
  }
  places = std::move(merged);
}

}  // namespace

GeoPoint Place::position() const { return position_of(follower->position(), layer().line); }

bool Place::is_on_segment(double along_m) const {
  return along_m >= -kEndMarginM && along_m <= layer().line.length_m() + kEndMarginM;
}

bool Place::is_near_end(double ahead_m) const {
  return follower->position().along_m + ahead_m > layer().line.length_m();
}

Followed Place::advance(SeenFrame& frame) {
  const double before_m = follower->position().along_m;
  Followed followed = follower->follow(frame);
  timestamp_s = frame.timestamp_s();
  measured = followed.measured;
  matches = followed.matches;
  log_bayes_factor = followed.log_bayes_factor;
  weighed = false;
  apart_m = 0;
  odds.move(follower->position().along_m - before_m);
  return followed;
}

void Place::weigh(double best, const std::optional<CoarsePosition>& reading) {
  weighed = true;
  odds.add_frame(log_bayes_factor, best, follower->position().along_m);
  if (reading) odds.add(receiver.log_bayes_factor(*reading, position(), timestamp_s));
}

void weigh(std::vector<Place>& places, const std::optional<CoarsePosition>& reading,
           std::size_t most) {
  merge_same(places);
  double best = 0;
  for (const Place& place : places) best = std::max(best, place.log_bayes_factor);
  for (Place& place : places) {
    if (!place.weighed) place.weigh(best, reading);
  }
  std::erase_if(places, [](const Place& place) { return place.odds.log() < kMinLogOdds; });
  std::ranges::stable_sort(places, std::greater<>(),
                           [](const Place& place) { return place.odds.log(); });
  if (places.size() > most)
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(most), places.end());
}

double log_odds_of_first(const std::vector<Place>& places) {
  double against = 1;  // elsewhere
  for (std::size_t i = 1; i < places.size(); ++i) against += std::exp(places[i].odds.log());
  return places.front().odds.log() - std::log(against);
}

double log_density_after(const Place& left, const Place& place) {
  constexpr double kAccelerationMps2 = 2;
  if (left.layer().key != place.layer().key) return 0;
  const double since_s = place.timestamp_s - left.timestamp_s;
  const double off_m =
      place.follower->position().along_m - left.follower->position_at(place.timestamp_s).along_m;
  const double sigma_m =
      0.5 + left.follower->position().sigma_m + kAccelerationMps2 * since_s * since_s / 2;
  const double sigmas = off_m / sigma_m;
  return -sigmas * sigmas / 2;
}

}  // namespace milepost
