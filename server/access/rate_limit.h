// How often a client may ask.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

namespace milepost::server {

struct RateSettings {
  double requests_per_s = 0;  // of one client, in the long run; 0: no limit
  double burst = 0;           // requests at once after a pause; 0: those of ten seconds
};

// A token bucket for each client, as the time at which it will be full again (the generic cell rate
// algorithm). Remembers clients only while their buckets are not full, and at most kClients of
// them: further ones share a bucket. Safe to use from several threads at once.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kClients = 262'144;

  explicit RateLimit(const RateSettings& settings);

  bool is_limited() const { return interval_.count() > 0; }
  // Zero if the client may ask now, which counts; else how long it has to wait.
  Clock::duration wait(std::string_view client, Clock::time_point now);

 private:
  struct Shard {
    std::mutex mutex;
    std::unordered_map<std::string, Clock::time_point> full_at;  // guarded by mutex
    std::size_t forget_at = 64;                                  // the same
    Clock::time_point others_full_at;                            // the same
  };
  static void forget_full(Shard& shard, Clock::time_point now);
  static Clock::time_point& bucket_of(Shard& shard, std::string_view client, Clock::time_point now);

  Clock::duration interval_{};                    // in which one more request is allowed
  Clock::duration tolerance_{};                   // for those at once
  std::array<std::unique_ptr<Shard>, 8> shards_;  // so that threads seldom wait for each other
};

}  // namespace milepost::server
