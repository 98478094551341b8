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
  const double novel =
      seen_ ? std::min(1.0, std::abs(along_m - seen_from_m_) / settings_.novel_m) : 1.0;
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
  seen_ = true;
  seen_from_m_ = along_m;
}

}  // namespace milepost
