#include "client/localize/second_look.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr int kFirstLooks = 10;     // frame by frame
constexpr double kLookAgainM = 5;   // of way between later ones
constexpr double kRivalPart = 0.9;  // of the matches, from which the pose is uncertain
constexpr double kMoreAgree = 1.1;  // times the matches, from which a look is against the pose
constexpr int kCalmLooks = 3;       // without a rival, until the pose is certain again
constexpr int kLooksAgainst = 2;    // in turn, until the belief begins again

}  // namespace

bool SecondLook::is_due(double along_m) const {
  return looks_ < kFirstLooks || apart_m_ > 0 || std::abs(along_m - looked_from_m_) >= kLookAgainM;
}

std::optional<LearnedCamera> SecondLook::camera(const Place& place) const {
  if (looks_ < kFirstLooks || apart_m_ > 0) return std::nullopt;
  return place.follower->learned_camera();
}

void SecondLook::compare(Place& place, std::vector<Sighting> sightings) {
  ++looks_;
  looked_from_m_ = place.follower->position().along_m;
  const auto most = std::ranges::max_element(sightings, {}, &Sighting::matches);
  const double apart_m =
      most == sightings.end()
          ? 0
          : geodesic_distance_m(position_of(most->follower->position(), place.layer().line),
                                place.position());
  const bool is_rival =
      apart_m > kAgreedM && apart_m < kSamePlaceM && most->matches > kRivalPart * place.matches;
  const bool is_against = is_rival && most->matches > kMoreAgree * place.matches;
  against_ = is_against ? against_ + 1 : 0;
  calm_ = is_rival ? 0 : calm_ + 1;
  if (is_rival) apart_m_ = apart_m;
  if (calm_ >= kCalmLooks) apart_m_ = 0;
  place.apart_m = apart_m_;
  if (against_ < kLooksAgainst) return;
  place.follower = std::move(most->follower);
  place.matches = most->matches;
  place.log_bayes_factor = most->log_bayes_factor;
  against_ = 0;
}

}  // namespace milepost
