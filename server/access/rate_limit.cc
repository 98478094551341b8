#include "server/access/rate_limit.h"

#include <algorithm>
#include <functional>
#include <iterator>

namespace milepost::server {
namespace {

constexpr double kBurstS = 10;

RateLimit::Clock::duration of_seconds(double count) {
  return std::chrono::duration_cast<RateLimit::Clock::duration>(
      std::chrono::duration<double>(count));
}

}  // namespace

RateLimit::RateLimit(const RateSettings& settings) {
  for (auto& shard : shards_) shard = std::make_unique<Shard>();
  if (settings.requests_per_s <= 0) return;
  const double burst =
      settings.burst > 0 ? settings.burst : std::max(1.0, kBurstS * settings.requests_per_s);
  interval_ = std::max(of_seconds(1 / settings.requests_per_s), Clock::duration(1));
  tolerance_ = of_seconds((burst - 1) / settings.requests_per_s);
}

RateLimit::Clock::duration RateLimit::wait(std::string_view client, Clock::time_point now) {
  if (!is_limited()) return Clock::duration::zero();
  Shard& shard = *shards_[std::hash<std::string_view>()(client) % shards_.size()];
  const std::lock_guard lock(shard.mutex);
  Clock::time_point& full_at = bucket_of(shard, client, now);
  const Clock::time_point begin = std::max(full_at, now);
  if (begin - now > tolerance_) return begin - now - tolerance_;
  full_at = begin + interval_;
  return Clock::duration::zero();
}

// Of a full one only the first call need be remembered: the next one forgets those that are full.
RateLimit::Clock::time_point& RateLimit::bucket_of(Shard& shard, std::string_view client,
                                                   Clock::time_point now) {
  const std::string key(client);
  const auto found = shard.full_at.find(key);
  if (found != shard.full_at.end()) return found->second;
  if (shard.full_at.size() >= shard.forget_at) forget_full(shard, now);
  if (shard.full_at.size() >= kClients / 8) return shard.others_full_at;
  return shard.full_at[key];
}

void RateLimit::forget_full(Shard& shard, Clock::time_point now) {
  std::erase_if(shard.full_at, [now](const auto& bucket) { return bucket.second <= now; });
  shard.forget_at = std::max<std::size_t>(64, 2 * shard.full_at.size());
}

}  // namespace milepost::server
