#include "client/fetch/backoff.h"

#include <algorithm>
#include <cmath>

namespace milepost {

void Backoff::failed(SteadyTime now, double retry_after_s, const BackoffSettings& settings,
                     std::mt19937& random) {
  const double doubled_s = settings.first_s * std::exp2(std::min(failures_, 20));
  const double pause_s = std::min(std::max(doubled_s, retry_after_s), settings.longest_s);
  std::uniform_real_distribution<double> jitter(1 - settings.jitter, 1 + settings.jitter);
  const std::chrono::duration<double> pause(pause_s * jitter(random));
  due_ = now + std::chrono::duration_cast<SteadyTime::duration>(pause);
  ++failures_;
}

}  // namespace milepost
