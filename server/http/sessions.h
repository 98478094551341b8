// Registry of open sessions, to count and to stop them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace milepost::server {

class Session;

// Safe to use from several threads at once.
class Sessions {
 public:
  // False after stop(): the session must not start.
  bool add(const std::shared_ptr<Session>& session);
  void remove(const Session* session);
  std::size_t count() const;
  // Prevents further sessions from starting and returns those that are open.
  std::vector<std::shared_ptr<Session>> stop();
  // Waits until no session is open. False on timeout.
  bool wait_none(std::chrono::milliseconds at_most);

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;                                  // guarded by mutex_
  std::map<const Session*, std::weak_ptr<Session>> open_;  // guarded by mutex_
};

}  // namespace milepost::server
