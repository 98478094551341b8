// One thread of the server with its connections.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <thread>

#include <boost/asio/executor_work_guard.hpp>

#include "server/http/deadlines.h"
#include "server/http/shared.h"
#include "server/http/sockets.h"
#include "server/listen/accepted.h"
#include "server/message/head.h"

namespace milepost::server {

// Its methods are for its own thread, except where noted.
class Worker {
 public:
  // `shared` must outlive the worker.
  explicit Worker(Shared& shared);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // From any thread.
  void start();
  void adopt(Accepted accepted);
  // When the connection that has been idle for longest expires; the maximum if none is idle.
  Clock::time_point first_idle_deadline() const {
    return Clock::time_point(Clock::duration(first_idle_.load(std::memory_order_relaxed)));
  }
  // Lets responses end, and requests that are on their way be answered; then the thread ends.
  void finish();
  // Closes all connections.
  void abort();
  // Waits until the thread ends. False on timeout.
  bool ended_by(Clock::time_point deadline) const;
  void join();
  net::io_context& context() { return context_; }

  Shared& shared() { return shared_; }
  bool finishing() const { return finishing_; }
  void wait(Waiting& waiting, Phase phase);
  // A connection has ended.
  void forget(Waiting& waiting);
  // For bytes that are received; valid until the next connection receives.
  std::array<char, 65536>& scratch() { return scratch_; }
  // HeadEnds of now.
  std::string_view head_end(unsigned http_version, bool keep_alive);

 private:
  void take(Accepted accepted);
  bool close_longest_idle();
  void publish_first_idle();
  void close_expired();
  void arm(Clock::time_point deadline);
  void end_if_done();

  Shared& shared_;
  Deadlines deadlines_;  // outlives the context, whose handlers keep the connections
  HeadEnds head_ends_;
  std::array<char, 65536> scratch_{};
  std::atomic<Clock::rep> first_idle_ = Clock::duration::max().count();
  bool finishing_ = false;

  net::io_context context_{1};
  std::optional<net::executor_work_guard<Executor>> work_;
  Timer timer_;
  Clock::time_point armed_ = Clock::time_point::max();

  std::thread thread_;
  std::promise<void> ended_;
  std::shared_future<void> has_ended_ = ended_.get_future().share();
};

}  // namespace milepost::server
