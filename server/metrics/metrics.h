// What the server counts, as Prometheus reads it.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "server/catalog/catalog.h"

namespace milepost::server {

// One response that was sent, or aborted.
struct SentResponse {
  std::string_view route;  // a pattern of handle.h; empty: none fits
  std::string_view map;    // empty: of no map
  unsigned status = 0;
  std::uint64_t body_bytes = 0;
  std::uint64_t tiles = 0;  // and cells in the body
  std::chrono::nanoseconds took{};
  bool aborted = false;
};

// Counts without locks, but for what is counted by map. Safe to use from several threads at once.
class Metrics {
 public:
  // `routes`: all patterns.
  explicit Metrics(const std::vector<std::string_view>& routes);
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void count(const SentResponse& response);

  enum class Kind { counter, gauge };
  // A number that is asked for at each scrape, from any thread.
  void add(const std::string& name, const std::string& help, Kind kind,
           std::function<double()> value);

  // In Prometheus' text format.
  std::string text(const Catalog& catalog) const;

  // Upper bounds, in seconds, of the buckets of durations.
  static constexpr std::array<double, 12> kBucketsS = {0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03,
                                                       0.1,    0.3,    1,     3,     10,   30};

 private:
  // A cache line of its own, so that threads seldom wait for each other.
  struct alignas(64) RouteCount {
    std::array<std::atomic<std::uint64_t>, 600> by_status{};
    std::array<std::atomic<std::uint64_t>, kBucketsS.size() + 1> by_duration{};
    std::atomic<std::uint64_t> nanoseconds{0};
    std::atomic<std::uint64_t> bytes{0};
  };
  struct MapCount {
    std::uint64_t tiles = 0;
    std::uint64_t bytes = 0;
  };
  struct Source {
    std::string name;
    std::string help;
    Kind kind = Kind::gauge;
    std::function<double()> value;
  };
  RouteCount& route_of(std::string_view route);

  std::map<std::string, RouteCount, std::less<>> routes_;  // constant but for the counts
  std::atomic<std::uint64_t> aborted_{0};
  mutable std::mutex mutex_;
  std::map<std::string, MapCount, std::less<>> maps_;  // guarded by mutex_
  std::vector<Source> sources_;                        // the same
};

}  // namespace milepost::server
