// Writes the log from a thread of its own: whoever has a line to say never waits for its reader.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace milepost::server {

// A descriptor may block for ever: a pipe that nobody reads, a terminal that is halted, a file
// system that hangs. Lines wait in a bounded queue meanwhile; those that find it full, and those
// that the descriptor refuses (a full disk), are dropped and counted, and a line in their place
// says how many are missing. Safe to use from several threads at once.
class LogWriter {
 public:
  // `descriptor` must stay open until the process ends; it is used as it is, so that its flags,
  // which other processes share, are not changed. `queue_bytes` is how much may wait.
  explicit LogWriter(int descriptor, std::size_t queue_bytes = 1'048'576);
  ~LogWriter();  // close(), without waiting
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Queues a line, which ends in '\n'. Never waits for the descriptor.
  void write(std::string_view line);
  // Lines dropped so far.
  std::uint64_t dropped() const;
  // Takes no further line and waits until all that wait are written. False if `at_most` ran out
  // before: the rest is lost when the process ends.
  bool close(std::chrono::milliseconds at_most);

 private:
  struct State;  // shared with the thread, which may be stuck in a write for longer than we live
  std::shared_ptr<State> state_;
};

}  // namespace milepost::server
