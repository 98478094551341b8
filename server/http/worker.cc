#include "server/http/worker.h"

#include <utility>

#include <boost/asio/post.hpp>

#include "server/http/session.h"

namespace milepost::server {
namespace {

constexpr std::chrono::milliseconds kTimerStep{10};  // deadlines this near are one
constexpr int kLooksForIdle = 8;

}  // namespace

Worker::Worker(Shared& shared)
    : shared_(shared), deadlines_(shared.limits), timer_(context_.get_executor()) {}

Worker::~Worker() { join(); }

void Worker::start() {
  work_.emplace(context_.get_executor());
  thread_ = std::thread([this] {
    context_.run();
    ended_.set_value();
  });
}

void Worker::adopt(Accepted accepted) {
  net::post(context_,
            [this, accepted = std::move(accepted)]() mutable { take(std::move(accepted)); });
}

void Worker::finish() {
  net::post(context_, [this] {
    finishing_ = true;
    while (Waiting* waiting = deadlines_.first(Phase::idle)) wait(*waiting, Phase::last);
    end_if_done();
  });
}

void Worker::abort() {
  net::post(context_, [this] {
    for (const Phase phase :
         {Phase::disk, Phase::idle, Phase::request, Phase::send, Phase::linger, Phase::last}) {
      while (Waiting* waiting = deadlines_.first(phase)) waiting->close();
    }
  });
}

bool Worker::ended_by(Clock::time_point deadline) const {
  return has_ended_.wait_until(deadline) == std::future_status::ready;
}

void Worker::join() {
  if (thread_.joinable()) thread_.join();
}

void Worker::wait(Waiting& waiting, Phase phase) {
  deadlines_.enter(waiting, phase, Clock::now());
  arm(waiting.deadline);
  publish_first_idle();
}

void Worker::forget(Waiting& waiting) {
  waiting.unlink();
  publish_first_idle();
  end_if_done();
}

void Worker::publish_first_idle() {
  const Waiting* first = deadlines_.first(Phase::idle);
  const auto deadline = first == nullptr ? Clock::time_point::max() : first->deadline;
  first_idle_.store(deadline.time_since_epoch().count(), std::memory_order_relaxed);
}

std::string_view Worker::head_end(unsigned http_version, bool keep_alive) {
  return head_ends_.end(std::time(nullptr), http_version, keep_alive);
}

void Worker::take(Accepted accepted) {
  Admission::Ticket& ticket = accepted.ticket;
  if (ticket.verdict() == Admission::Verdict::replace && !close_longest_idle()) ticket.reject();
  const Admission::Verdict verdict = ticket.verdict();
  if (verdict == Admission::Verdict::drop) return;
  const auto session = std::make_shared<Session>(*this, std::move(accepted));
  verdict == Admission::Verdict::reject ? session->reject() : session->start();
}

// False if there is none.
bool Worker::close_longest_idle() {
  for (int i = 0; i < kLooksForIdle; ++i) {
    Waiting* longest = deadlines_.first(Phase::idle);
    if (longest == nullptr) return false;
    if (!longest->has_bytes()) {
      longest->close();
      return true;
    }
    wait(*longest, Phase::idle);  // its next request has arrived
  }
  return false;
}

void Worker::close_expired() {
  const Clock::time_point now = Clock::now();
  while (Waiting* waiting = deadlines_.expired(now)) waiting->expire();
  armed_ = Clock::time_point::max();
  if (const auto earliest = deadlines_.earliest()) arm(*earliest);
}

// Sets the timer, which may go off too early: deadlines move on with each request.
void Worker::arm(Clock::time_point deadline) {
  if (deadline >= armed_) return;
  armed_ = deadline;
  timer_.expires_at(deadline + kTimerStep);
  timer_.async_wait([this](const error_code& error) {
    if (!error) close_expired();
  });
}

void Worker::end_if_done() {
  if (!finishing_ || !deadlines_.empty()) return;
  work_.reset();
  timer_.cancel();
}

}  // namespace milepost::server
