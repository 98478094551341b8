#include "server/http/sessions.h"

namespace milepost::server {

bool Sessions::add(const std::shared_ptr<Session>& session) {
  const std::lock_guard lock(mutex_);
  if (!stopping_) open_[session.get()] = session;
  return !stopping_;
}

void Sessions::remove(const Session* session) {
  const std::lock_guard lock(mutex_);
  open_.erase(session);
  changed_.notify_all();
}

std::size_t Sessions::count() const {
  const std::lock_guard lock(mutex_);
  return open_.size();
}

std::vector<std::shared_ptr<Session>> Sessions::stop() {
  std::vector<std::shared_ptr<Session>> sessions;
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  for (const auto& [key, session] : open_) {
    if (auto open = session.lock()) sessions.push_back(std::move(open));
  }
  return sessions;
}

bool Sessions::wait_none(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, at_most, [this] { return open_.empty(); });
}

}  // namespace milepost::server
