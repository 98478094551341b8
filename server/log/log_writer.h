// Asynchronous log output: a thread writes the lines, so that callers never block.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace milepost::server {

// A descriptor may block for ever: a pipe that nobody reads, a suspended terminal, a hanging file
// system. Lines wait in a bounded queue; lines that find it full or that the descriptor rejects (a
// full disk) are dropped and counted, and a line in their place reports their number. Safe to use
// from several threads at once.
class LogWriter {
 public:
  // `descriptor` must stay open until the process ends; its flags, which other processes share, are
  // not changed. `queue_bytes` is the capacity of the queue.
  explicit LogWriter(int descriptor, std::size_t queue_bytes = 1'048'576);
  ~LogWriter();  // close(), without waiting
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Queues a line, which ends in '\n'. Never blocks on the descriptor.
  void write(std::string_view line);
  // Lines dropped so far.
  std::uint64_t dropped() const;
  // Stops accepting lines and waits until the queue is written. False on timeout: the rest is lost
  // when the process ends.
  bool close(std::chrono::milliseconds at_most);

 private:
  struct State;  // shared with the thread, which may block in a write and outlive this object
  std::shared_ptr<State> state_;
};

}  // namespace milepost::server
