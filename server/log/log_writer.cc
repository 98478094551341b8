#include "server/log/log_writer.h"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace milepost::server {
namespace {

std::uint64_t lines_in(std::string_view text) {
  return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

// Blocks as long as necessary. Returns the rest that the descriptor did not accept.
std::string_view write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN) {  // set by another process that shares it
      pollfd ready{descriptor, POLLOUT, 0};
      ::poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      return text;
    }
  }
  return text;
}

}  // namespace

struct LogWriter::State {
  State(int opened, std::size_t bytes) : descriptor(opened), queue_bytes(bytes) {}

  const int descriptor;
  const std::size_t queue_bytes;

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::string waiting;           // guarded by mutex, like all below: whole lines
  std::uint64_t dropped = 0;     // lines, since the start
  std::uint64_t unreported = 0;  // those not yet reported by a line of the log
  bool closed = false;           // no further line is accepted
  bool ended = false;            // the thread writes nothing more

  // The text to write next: the queued lines, and after them the number of missing lines, if any.
  struct Batch {
    std::string text;
    std::uint64_t reported = 0;  // lines missing
  };

  // Waits for lines. Empty if the writer is closed and none are left.
  Batch take() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return closed || !waiting.empty(); });
    Batch batch{std::exchange(waiting, {}), 0};
    if (batch.text.empty() || unreported == 0) return batch;
    batch.reported = std::exchange(unreported, 0);
    batch.text += "milepost-server: " + std::to_string(batch.reported) +
                  " lines of the log are missing before this one; they could not be written\n";
    return batch;
  }

  // REQUIRES: `rest`, the end of the batch, could not be written.
  void drop(const Batch& batch, std::string_view rest) {
    const std::lock_guard lock(mutex);
    const std::uint64_t lines = lines_in(rest) - (batch.reported > 0 ? 1 : 0);
    dropped += lines;
    unreported += lines + batch.reported;
  }

  void run() {
    for (Batch batch = take(); !batch.text.empty(); batch = take()) {
      const std::string_view rest = write_all(descriptor, batch.text);
      if (!rest.empty()) drop(batch, rest);
    }
    const std::lock_guard lock(mutex);
    ended = true;
    changed.notify_all();
  }
};

LogWriter::LogWriter(int descriptor, std::size_t queue_bytes)
    : state_(std::make_shared<State>(descriptor, queue_bytes)) {
  // The thread blocks all signals: other threads handle those that stop the program, and a pipe
  // without a reader is an error of write().
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread([state = state_] { state->run(); }).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

LogWriter::~LogWriter() { close(std::chrono::milliseconds(0)); }

void LogWriter::write(std::string_view line) {
  const std::lock_guard lock(state_->mutex);
  if (state_->closed || state_->waiting.size() + line.size() > state_->queue_bytes) {
    ++state_->dropped;
    ++state_->unreported;
    return;
  }
  state_->waiting += line;
  state_->changed.notify_all();
}

std::uint64_t LogWriter::dropped() const {
  const std::lock_guard lock(state_->mutex);
  return state_->dropped;
}

bool LogWriter::close(std::chrono::milliseconds at_most) {
  std::unique_lock lock(state_->mutex);
  state_->closed = true;
  state_->changed.notify_all();
  return state_->changed.wait_for(lock, at_most, [this] { return state_->ended; });
}

}  // namespace milepost::server
