#include "server/http/listener.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <boost/asio/post.hpp>

namespace milepost::server {
namespace {

constexpr std::chrono::milliseconds kPauseAfterError{100};
constexpr std::chrono::milliseconds kPauseForRoom{5};
constexpr std::chrono::seconds kBetweenWarnings{1};
constexpr int kAcceptedAtOnce = 64;  // then connections have their turn

// The connection was gone before it was accepted; others may wait.
bool is_of_one_connection(int error) {
  return error == ECONNABORTED || error == EINTR || error == EPROTO || error == EPERM;
}

}  // namespace

Listener::Listener(std::vector<ListeningSocket> sockets, Shared& shared,
                   const std::vector<std::unique_ptr<Worker>>& workers)
    : shared_(shared), workers_(workers) {
  for (ListeningSocket& socket : sockets) {
    doors_.push_back(std::make_unique<Door>(std::move(socket), workers.front()->context()));
  }
}

void Listener::start() {
  for (const auto& door : doors_) {
    const net::generic::stream_protocol any(AF_INET, 0);  // only waited on: the family is not used
    door->acceptor.assign(any, door->socket.descriptor());
    await(*door);
  }
}

void Listener::close() {
  std::promise<void> closed;
  net::post(workers_.front()->context(), [this, &closed] {
    for (const auto& door : doors_) {
      while (accept_one(*door)) {
      }
      door->pause.cancel();
      door->acceptor.release();
    }
    doors_.clear();
    closed_ = true;
    closed.set_value();
  });
  closed.get_future().wait();
}

void Listener::await(Door& door) {
  door.acceptor.async_wait(Acceptor::wait_read, [this, &door](const error_code& error) {
    if (!error && !closed_) accept(door);
  });
}

void Listener::accept(Door& door) {
  for (int i = 0; i < kAcceptedAtOnce; ++i) {
    if (shared_.admission.overfull()) return pause(door, kPauseForRoom);
    if (accept_one(door)) continue;
    if (errno == EAGAIN) break;
    spdlog::warn("{}: a connection cannot be accepted ({}); accepting continues",
                 door.socket.address(), std::generic_category().message(errno));
    return pause(door, kPauseAfterError);
  }
  await(door);
}

void Listener::pause(Door& door, std::chrono::milliseconds duration) {
  door.pause.expires_after(duration);
  door.pause.async_wait([this, &door](const error_code& ended) {
    if (!ended && !closed_) accept(door);
  });
}

// False if there is none, or none can be accepted as memory or descriptors are short: errno is set.
bool Listener::accept_one(Door& door) {
  SocketAddress address;
  const int descriptor = ::accept4(door.socket.descriptor(), address.data(), &address.bytes,
                                   SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (descriptor < 0 && !is_of_one_connection(errno)) return false;
  if (descriptor >= 0) welcome(descriptor, address, door);
  return true;
}

void Listener::welcome(int descriptor, const SocketAddress& address, const Door& door) {
  const int on = 1;
  if (!address.is_unix()) {
    ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  }
  Peer peer = Peer::of(address);
  Admission::Ticket ticket = shared_.admission.enter(peer);
  const Admission::Verdict verdict = ticket.verdict();
  const bool through_tls = shared_.tls != nullptr && !door.socket.plain();
  Accepted accepted(descriptor, address.storage.ss_family, through_tls, std::move(peer),
                    std::move(ticket));
  if (verdict == Admission::Verdict::reject || verdict == Admission::Verdict::drop) {
    warn_of_rejection();
  }
  if (verdict != Admission::Verdict::drop) worker_for(verdict).adopt(std::move(accepted));
}

// One after the other; if a connection has to go, the one where that has been idle for longest.
Worker& Listener::worker_for(Admission::Verdict verdict) {
  if (verdict == Admission::Verdict::replace) {
    return **std::ranges::min_element(
        workers_, {}, [](const auto& worker) { return worker->first_idle_deadline(); });
  }
  next_worker_ = (next_worker_ + 1) % workers_.size();
  return *workers_[next_worker_];
}

void Listener::warn_of_rejection() {
  ++rejected_;
  const Clock::time_point now = Clock::now();
  if (now - warned_ < kBetweenWarnings) return;
  spdlog::warn("{} connections are rejected: {} are open", rejected_, shared_.admission.count());
  warned_ = now;
  rejected_ = 0;
}

}  // namespace milepost::server
