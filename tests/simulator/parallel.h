// Parallel execution of independent tasks.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "schema/base/result.h"

namespace milepost::simulator {

// Called after each task with the number of tasks done and of all; from one thread at a time.
// Returns whether to continue.
using Progress = std::function<bool(std::size_t, std::size_t)>;

// Calls `make` (index -> Status) for each index below `count`, on `threads` threads; the first
// failure ends it. Errors: those of `make`; cancelled.
template <class Make>
Status for_each_in_parallel(std::size_t count, int threads, const Progress& progress, Make make) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;  // guards done and failure
  std::size_t done = 0;
  std::optional<Error> failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      const Status status = make(i);
      const std::lock_guard lock(mutex);
      ++done;
      if (!status && !failure) failure = status.error();
      if (!failure && progress && !progress(done, count)) {
        failure = Error{ErrorCode::cancelled, "", "stopped on request", ""};
      }
      if (failure) return;
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (failure) return *failure;
  return ok_status();
}

}  // namespace milepost::simulator
