#include "client/localize/gnss_likelihood.h"

#include <algorithm>
#include <cmath>

#include "client/estimation/student_t.h"

namespace milepost {

double GnssLikelihood::log_bayes_factor(const GnssFix& reading, const GeoPoint& place,
                                        double now_s) {
  if (counted_ && reading.timestamp_s <= counted_->timestamp_s) return 0;
  const double aged_m = settings_.speed_mps * std::max(0.0, now_s - reading.timestamp_s);
  const double sigma_m = std::hypot(reading.sigma_m, aged_m);
  const EnuPoint off = LocalFrame(place).enu_from_geo(reading.position);
  double independent = 1;
  if (counted_) {
    const double moved_m =
        std::hypot(off.east_m - counted_->off.east_m, off.north_m - counted_->off.north_m);
    const double lasted_s = reading.timestamp_s - counted_->timestamp_s;
    independent = std::min(1.0, std::max(lasted_s / settings_.correlation_s,
                                         moved_m / sigma_m / settings_.moved_sigmas));
  }
  counted_ = Counted{reading.timestamp_s, off};
  const auto log_density = [&](double sigmas) {
    return log_student_t(sigmas * sigmas, settings_.degrees);
  };
  const double log_bayes_factor = log_density(std::hypot(off.east_m, off.north_m) / sigma_m) -
                                  log_density(settings_.elsewhere_sigmas);
  return std::max(independent * log_bayes_factor, -settings_.max_against);
}

}  // namespace milepost
