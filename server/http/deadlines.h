// When the connections of a thread have waited for long enough.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <boost/intrusive/list.hpp>

#include "server/http/settings.h"
#include "server/http/sockets.h"

namespace milepost::server {

// What a connection waits for.
enum class Phase {
  disk,     // what is read from the disk: no deadline
  idle,     // the first byte of a request
  request,  // the rest of a request
  send,     // a client that takes bytes of a response
  linger,   // a client that closes after the last response
  last,     // a request that is on its way at a stop
};

// Base of what waits: in one list of Deadlines, from enter() to its end.
struct Waiting
    : boost::intrusive::list_base_hook<boost::intrusive::link_mode<boost::intrusive::auto_unlink>> {
  Phase phase = Phase::disk;
  Clock::time_point deadline = Clock::time_point::max();

  // The time of its phase is over: enters another one, or closes.
  virtual void expire() = 0;
  virtual void close() = 0;
  // Bytes have arrived that were not received yet.
  virtual bool has_bytes() const = 0;

  virtual ~Waiting() = default;
};

// Each phase has one duration, so that the first to enter it is the first to expire: a list a phase
// replaces a timer a connection. Not safe to use from several threads at once.
class Deadlines {
 public:
  explicit Deadlines(const ConnectionLimits& limits);

  void enter(Waiting& waiting, Phase phase, Clock::time_point now);
  // One whose deadline is not after `now`, or null.
  Waiting* expired(Clock::time_point now);
  std::optional<Clock::time_point> earliest() const;
  // The first of those in a phase, or null.
  Waiting* first(Phase phase);
  bool empty() const;

 private:
  using List = boost::intrusive::list<Waiting, boost::intrusive::constant_time_size<false>>;
  static constexpr std::size_t kPhases = 6;

  std::array<std::chrono::milliseconds, kPhases> limits_;  // by phase
  std::array<List, kPhases> lists_;                        // by phase, first deadline first
};

}  // namespace milepost::server
