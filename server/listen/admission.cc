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
  if (admission_ == nullptr) return;
  const std::lock_guard lock(admission_->mutex_);
  admission_->remove(*this);
}

void Admission::Ticket::reject() {
  const std::lock_guard lock(admission_->mutex_);
  admission_->remove(*this);
  verdict_ = admission_->rejection();
  admission_->add(*this);
}

Admission::Admission(std::size_t connections, std::size_t per_address)
    : connections_(connections),
      per_address_(per_address),
      rejections_(std::clamp<std::size_t>(connections / 8, 1, 64)) {}

Admission::Ticket Admission::enter(const Peer& peer) {
  const std::lock_guard lock(mutex_);
  Ticket ticket(*this, verdict_for(peer), peer);
  add(ticket);
  return ticket;
}

bool Admission::overfull() const {
  const std::lock_guard lock(mutex_);
  return served_ >= connections_ + rejections_;
}

std::size_t Admission::count() const {
  const std::lock_guard lock(mutex_);
  return served_ + rejected_;
}

// The following four: REQUIRES: mutex_ is held.

Admission::Verdict Admission::verdict_for(const Peer& peer) const {
  const auto same = by_address_.find(peer.key);
  const bool over = peer.counted && same != by_address_.end() && same->second >= per_address_;
  if (over) return rejection();
  return served_ < connections_ ? Verdict::serve : Verdict::replace;
}

Admission::Verdict Admission::rejection() const {
  return rejected_ < rejections_ ? Verdict::reject : Verdict::drop;
}

void Admission::add(const Ticket& ticket) {
  if (ticket.verdict_ == Verdict::reject) ++rejected_;
  if (!is_served(ticket.verdict_)) return;
  ++served_;
  if (ticket.counted_) ++by_address_[ticket.key_];
}

void Admission::remove(const Ticket& ticket) {
  if (ticket.verdict_ == Verdict::reject) --rejected_;
  if (!is_served(ticket.verdict_)) return;
  --served_;
  if (!ticket.counted_) return;
  const auto same = by_address_.find(ticket.key_);
  if (--same->second == 0) by_address_.erase(same);
}

}  // namespace milepost::server
