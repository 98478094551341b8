#include "client/localize/log_odds.h"

#include <algorithm>
#include <cmath>

namespace milepost {

void LogOdds::move(double by_m) {
  const double lapse = settings_.lapse * std::min(1.0, std::abs(by_m) / settings_.novel_m);
  const double odds = std::exp(log_);
  log_ = std::log(odds * (1 - lapse) / (1 + odds * lapse));
}

void LogOdds::add_frame(double log_bayes_factor, double best, double along_m) {
  const double novel = novelty(along_m);
  if (log_bayes_factor <= 0) {
    const double at_once = std::min(1.0, -log_bayes_factor / settings_.strongly_against);
    log_ += std::max(log_bayes_factor, -settings_.max_against) * std::max(novel, at_once);
    return;
  }
  const double still_counted = (1 - novel) * counted_;
  const double whole = std::min(log_bayes_factor, settings_.max_for);
  const double more =
      std::max(std::min(novel * log_bayes_factor, settings_.max_for), whole - still_counted);
  log_ += more;
  log_ -= std::min(novel * (best - log_bayes_factor), settings_.max_for);
  counted_ = still_counted + more;
  remember(along_m);
}

double LogOdds::novelty(double along_m) const {
  if (!seen_from_) return 1;
  const double beyond_m = std::max(along_m - seen_from_->to_m, seen_from_->from_m - along_m);
  return std::clamp(beyond_m / settings_.novel_m, 0.0, 1.0);
}

// The way back from the latest frame, as far as its evidence is not independent.
void LogOdds::remember(double along_m) {
  const AlongRange now = {along_m, along_m};
  if (!seen_from_) seen_from_ = now;
  const bool is_ahead = along_m > seen_from_->to_m;
  const bool is_behind = along_m < seen_from_->from_m;
  seen_from_ = seen_from_->joined(now);
  if (is_ahead) seen_from_->from_m = std::max(seen_from_->from_m, along_m - settings_.novel_m);
  if (is_behind) seen_from_->to_m = std::min(seen_from_->to_m, along_m + settings_.novel_m);
}

}  // namespace milepost
