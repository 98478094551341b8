#include "client/localize/relocalization_check.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr int kFirstLooks = 10;         // at consecutive frames
constexpr double kLookAgainM = 5;       // distance travelled between later ones
constexpr double kUncertainPart = 0.9;  // of the matches: another pose makes this uncertain
constexpr double kMoreAgree = 1.1;      // of the matches: another pose contradicts this one
constexpr int kCalmLooks = 3;           // without an alternative, until the pose is certain again
constexpr int kLooksAgainst = 2;        // consecutive, until the belief is replaced

}  // namespace

bool RelocalizationCheck::is_due(double way_m) const {
  return looks_ < kFirstLooks || apart_m_ > 0 || std::abs(way_m - looked_from_m_) >= kLookAgainM;
}

std::optional<LearnedCamera> RelocalizationCheck::camera(const Hypothesis& hypothesis) const {
  if (looks_ < kFirstLooks || apart_m_ > 0) return std::nullopt;
  return hypothesis.tracker->learned_camera();
}

void RelocalizationCheck::compare(Hypothesis& hypothesis,
                                  std::vector<RelocalizationCandidate> candidates) {
  ++looks_;
  looked_from_m_ = hypothesis.way_m();
  const auto most = std::ranges::max_element(candidates, {}, &RelocalizationCandidate::matches);
  const double apart_m =
      most == candidates.end()
          ? 0
          : geodesic_distance_m(position_of(most->tracker->pose(), hypothesis.layer().line),
                                hypothesis.position());
  const bool is_alternative = apart_m > kAgreedM && apart_m < kSameHypothesisM &&
                              most->matches > kUncertainPart * hypothesis.matches;
  const bool is_against = is_alternative && most->matches > kMoreAgree * hypothesis.matches;
  against_ = is_against ? against_ + 1 : 0;
  calm_ = is_alternative ? 0 : calm_ + 1;
  if (is_alternative) apart_m_ = apart_m;
  if (calm_ >= kCalmLooks) apart_m_ = 0;
  hypothesis.apart_m = apart_m_;
  if (against_ < kLooksAgainst) return;
  hypothesis.tracker = std::move(most->tracker);
  hypothesis.matches = most->matches;
  hypothesis.log_bayes_factor = most->log_bayes_factor;
  against_ = 0;
}

}  // namespace milepost
