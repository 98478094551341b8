#include "server/listen/admission.h"

#include <algorithm>
#include <utility>

namespace milepost::server {
namespace {

bool is_served(Admission::Verdict verdict) {
  return verdict == Admission::Verdict::serve || verdict == Admission::Verdict::replace;
}

}  // namespace

Admission::Ticket::Ticket(Admission& admission, Verdict verdict, const Peer& peer)
    : admission_(&admission), verdict_(verdict), key_(peer.key), counted_(peer.counted) {}

Admission::Ticket::Ticket(Ticket&& other) noexcept
    : admission_(std::exchange(other.admission_, nullptr)),
      verdict_(other.verdict_),
      key_(other.key_),
      counted_(other.counted_) {}

Admission::Ticket::~Ticket() {
  if (admission_ != nullptr) admission_->leave(*this, key_, counted_);
}

Admission::Admission(std::size_t connections, std::size_t per_address)
    : connections_(connections),
      per_address_(per_address),
      rejections_(std::clamp<std::size_t>(connections / 8, 1, 64)) {}

Admission::Ticket Admission::enter(const Peer& peer) {
  const std::lock_guard lock(mutex_);
  const Verdict verdict = verdict_for(peer);
  if (is_served(verdict)) {
    ++served_;
    if (peer.counted) ++by_address_[peer.key];
  } else if (verdict == Verdict::reject) {
    ++rejected_;
  }
  return {*this, verdict, peer};
}

std::size_t Admission::count() const {
  const std::lock_guard lock(mutex_);
  return served_ + rejected_;
}

// REQUIRES: mutex_ is held.
Admission::Verdict Admission::verdict_for(const Peer& peer) const {
  const auto same = by_address_.find(peer.key);
  const bool over = peer.counted && same != by_address_.end() && same->second >= per_address_;
  if (over) return rejected_ < rejections_ ? Verdict::reject : Verdict::drop;
  if (served_ < connections_) return Verdict::serve;
  // Those that replace another are over the limit until it is closed.
  return served_ < connections_ + rejections_ ? Verdict::replace : Verdict::drop;
}

void Admission::leave(const Ticket& ticket, const Peer::Key& key, bool counted) {
  const std::lock_guard lock(mutex_);
  if (ticket.verdict() == Verdict::reject) --rejected_;
  if (!is_served(ticket.verdict())) return;
  --served_;
  if (!counted) return;
  const auto same = by_address_.find(key);
  if (--same->second == 0) by_address_.erase(same);
}

}  // namespace milepost::server
