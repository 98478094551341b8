#include "server/http/session.h"

#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <span>
#include <utility>

#include <boost/asio/post.hpp>

#include "server/message/cross_origin.h"

namespace milepost::server {
namespace {

constexpr int kRequestsAtOnce = 64;                 // then other connections have their turn
constexpr std::size_t kBytesAtOnce = 1'048'576;     // the same
constexpr std::size_t kStallBytes = 65'536;         // a client has `stall` to take them
constexpr std::size_t kDiscardedBytes = 1'048'576;  // at most, after the last response
constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

const PreparedAnswer& too_many_connections() {
  static const PreparedAnswer answer =
      prepared(problem(503, "too many connections are open; try again later"));
  return answer;
}

const PreparedAnswer& disk_is_busy() {
  static const PreparedAnswer answer =
      prepared(problem(503, "too many requests wait for the disk; try again later"));
  return answer;
}

const PreparedAnswer& request_timed_out() {
  static const PreparedAnswer answer =
      prepared(problem(408, "the request did not arrive in time; send it again at once"));
  return answer;
}

using State = Progress::State;

iovec piece_of(std::string_view bytes) {
  // Sending does not change them. NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
  return {const_cast<char*>(bytes.data()), bytes.size()};
}

}  // namespace

Session::Session(Worker& worker, Accepted accepted)
    : worker_(worker),
      shared_(worker.shared()),
      socket_(worker.context()),
      peer_(std::move(accepted.peer)),
      ticket_(std::move(accepted.ticket)),
      reader_(shared_.limits) {
  error_code error;
  const int descriptor = accepted.release();
  socket_.assign(net::generic::stream_protocol(accepted.family, 0), descriptor, error);
  if (error) ::close(descriptor);
  if (!error) socket_.native_non_blocking(true, error);
  if (!error) open_channel(accepted);
  closed_ = channel_ == nullptr;
}

void Session::open_channel(const Accepted& accepted) {
  const int descriptor = socket_.native_handle();
  channel_ = accepted.through_tls ? Channel::tls(descriptor, *shared_.tls->now())
                                  : Channel::plain(descriptor);
}

void Session::start() {
  if (closed_) return;
  in_request_ = has_bytes();  // or of its greeting, through TLS
  if (in_request_) worker_.wait(*this, Phase::request);
  establish();
}

void Session::reject() {
  rejected_ = true;
  start();
}

void Session::establish() {
  const Progress progress = channel_->establish();
  switch (progress.state) {
    case State::done:
      return end_establishing();
    case State::ended:
      ++shared_.failed_handshakes;
      return close();
    case State::needs_readable:
      await_readable();
      break;
    case State::needs_writable:
      await_writable();
      break;
  }
  if (in_request_) return;
  // The client may be silent as before a request, but not if it is rejected: it takes no idle
  // one's place.
  const Phase silent = worker_.finishing() ? Phase::last : Phase::idle;
  worker_.wait(*this, rejected_ ? Phase::request : silent);
}

void Session::end_establishing() {
  established_ = true;
  in_request_ = false;
  rejected_ ? refuse(too_many_connections()) : await_request();
}

void Session::expire() {
  if (phase == Phase::request && established_) {
    refuse(request_timed_out());
  } else if (phase == Phase::last && has_bytes()) {
    worker_.wait(*this, Phase::last);
  } else {
    close();
  }
}

bool Session::has_bytes() const {
  if (channel_->holds_bytes()) return true;
  int bytes = 0;
  // Asio has no const native_handle(). NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
  const int socket = const_cast<Socket&>(socket_).native_handle();
  return ::ioctl(socket, FIONREAD, &bytes) == 0 && bytes > 0;
}

void Session::close() {
  if (closed_) return;
  closed_ = true;
  if (responding_) report(true);
  outgoing_.end();
  error_code ignored;  // it is closed in any case
  socket_.close(ignored);
  worker_.forget(*this);
}

void Session::await_readable() {
  if (awaiting_readable_) return;
  awaiting_readable_ = true;
  socket_.async_wait(Socket::wait_read, [self = shared_from_this()](const error_code&) {
    self->awaiting_readable_ = false;
    if (!self->closed_) self->on_readable();
  });
}

void Session::await_writable() {
  if (awaiting_writable_) return;
  awaiting_writable_ = true;
  socket_.async_wait(Socket::wait_write, [self = shared_from_this()](const error_code&) {
    self->awaiting_writable_ = false;
    if (!self->closed_) self->on_writable();
  });
}

void Session::on_readable() {
  if (established_) return responding_ ? void() : receive();
  if (!in_request_) worker_.wait(*this, Phase::request);
  in_request_ = true;
  establish();
}

void Session::on_writable() {
  if (!established_) return establish();
  if (!responding_) return receive();
  send();
  serve();
}

void Session::await_bytes() {
  if (!channel_->holds_bytes()) return await_readable();
  net::post(worker_.context(), [self = shared_from_this()] {
    if (!self->closed_) self->on_readable();
  });
}

void Session::receive() {
  auto& scratch = worker_.scratch();
  const Progress received = channel_->receive(scratch);
  switch (received.state) {
    case State::done:
      break;
    case State::needs_readable:
      return await_readable();
    case State::needs_writable:
      return await_writable();
    case State::ended:
      return close();
  }
  if (phase == Phase::linger) return discard(received.bytes);
  reader_.add({scratch.data(), received.bytes});
  serve();
}

void Session::discard(std::size_t bytes) {
  discarded_bytes_ += bytes;
  if (discarded_bytes_ > kDiscardedBytes) return close();
  await_bytes();
}

// Answers the requests that have arrived.
void Session::serve() {
  int requests = 0;
  while (!closed_ && !responding_ && phase != Phase::linger) {
    if (requests == kRequestsAtOnce) {
      net::post(worker_.context(), [self = shared_from_this()] { self->serve(); });
      break;
    }
    if (!reader_.next(incoming_)) {
      await_request();
      break;
    }
    ++requests;
    in_request_ = false;
    answer();
  }
  reader_.keep();
}

void Session::await_request() {
  if (reader_.wants_continue()) {
    // There is room for it: nothing else is being sent.
    channel_->send(std::array{piece_of(kContinue)});
  }
  if (reader_.empty()) {
    worker_.wait(*this, worker_.finishing() ? Phase::last : Phase::idle);
  } else if (!in_request_) {
    worker_.wait(*this, Phase::request);
  }
  in_request_ = !reader_.empty();
  await_bytes();
}

void Session::answer() {
  begun_ = Clock::now();
  responding_ = true;
  if (incoming_.refusal) return respond({prepared(std::move(*incoming_.refusal)), {}, nullptr});
  grant_ = shared_.access.grant(incoming_.request.authorization);
  const auto wait = shared_.access.wait(grant_, peer_);
  if (wait.count() > 0) return respond({prepared(too_many_requests(wait)), {}, nullptr});
  Answer hot = answer_from_memory(incoming_.request, grant_, shared_);
  if (hot.prepared) return respond(std::move(hot));
  answer_later();
}

void Session::answer_later() {
  const bool accepted = shared_.disk.try_run(
      [self = shared_from_this(), request = incoming_.request, grant = grant_]() mutable {
        Worker& worker = self->worker_;
        Answer answer = answer_from_disk(request, grant, self->shared_);
        // The connection must end on its own thread: nothing of it stays here.
        net::post(worker.context(), [self = std::move(self), answer = std::move(answer)]() mutable {
          if (self->closed_) return;
          self->respond(std::move(answer));
          self->serve();
        });
      });
  if (!accepted) return respond({disk_is_busy(), {}, nullptr});
  worker_.wait(*this, Phase::disk);
}

// Answers what is no request, or none that can be served, and closes.
void Session::refuse(PreparedAnswer answer) {
  begun_ = Clock::now();
  responding_ = true;
  incoming_ = {{"-", "-"}, 11, false, {}};
  grant_ = Grant::without_token();
  respond({std::move(answer), {}, nullptr});
}

void Session::respond(Answer answer) {
  // At a stop, the last response to requests that have arrived says that it is the last.
  const bool last = worker_.finishing() && reader_.empty();
  keep_alive_ = incoming_.keep_alive && !last;
  broken_ = false;
  sent_bytes_ = 0;
  const Request& request = incoming_.request;
  const std::string lines =
      cross_origin_lines(shared_.allowed_origins, request.origin, request.method);
  outgoing_.begin(std::move(answer.prepared), std::move(answer.map), lines,
                  worker_.head_end(incoming_.http_version, keep_alive_), request.method != "HEAD");
  if (request.method != "HEAD") {
    for (Frame& frame : answer.frames) outgoing_.add(std::move(frame));
  }
  send();
}

// Sends until the response is complete, or something must be waited for.
void Session::send() {
  std::size_t limit = outgoing_.ready_bytes() + kBytesAtOnce;
  while (responding_ && !closed_) {
    add_hot_frames();
    if (outgoing_.complete()) return end_response();
    read_ahead();
    const std::size_t ready = outgoing_.ready_bytes();
    if (ready == 0 && broken_) return close();
    if (ready == 0) return worker_.wait(*this, Phase::disk);
    if (!send_some()) return;
    const std::size_t sent = ready - outgoing_.ready_bytes();
    if (sent >= limit) {
      net::post(worker_.context(), [self = shared_from_this()] {
        self->send();
        self->serve();
      });
      return;
    }
    limit -= sent;
  }
}

// False if nothing can be sent now.
bool Session::send_some() {
  std::array<iovec, 64> buffers;
  const std::size_t count = outgoing_.gather(buffers);
  const Progress progress = channel_->send(std::span(buffers).first(count));
  if (progress.state == State::needs_writable) await_room();
  if (progress.state == State::ended || progress.state == State::needs_readable) close();
  if (progress.state != State::done) return false;
  outgoing_.sent(progress.bytes);
  sent_bytes_ += progress.bytes;
  return true;
}

void Session::await_room() {
  if (phase != Phase::send || sent_bytes_ >= kStallBytes) {
    worker_.wait(*this, Phase::send);
    sent_bytes_ = 0;
  }
  await_writable();
}

void Session::add_hot_frames() {
  while (!reading_ && outgoing_.wants_frame()) {
    Frame frame = shared_.frames.find(frame_digest(outgoing_.response(), outgoing_.next_frame()));
    if (!frame) return;
    outgoing_.add(std::move(frame));
  }
}

void Session::read_ahead() {
  if (reading_ || broken_ || !outgoing_.wants_frame()) return;
  reading_ = true;
  shared_.disk.run([self = shared_from_this(), answer = outgoing_.answer(), map = outgoing_.map(),
                    first = outgoing_.next_frame()]() mutable {
    Worker& worker = self->worker_;
    auto frames = read_frames(answer->response, *map, first, self->shared_.frames);
    net::post(worker.context(), [self = std::move(self), frames = std::move(frames)]() mutable {
      self->reading_ = false;
      if (!self->closed_) self->add_frames(std::move(frames));
    });
  });
}

void Session::add_frames(Result<std::vector<Frame>> frames) {
  if (frames) {
    for (const Frame& frame : *frames) outgoing_.add(frame);
  } else {
    spdlog::error("{}", frames.error().line());
    broken_ = true;
  }
  if (!awaiting_writable_) send();
  serve();
}

void Session::end_response() {
  report(false);
  outgoing_.end();
  responding_ = false;
  if (!keep_alive_) linger();
}

// Closes so that the client receives the last response even if it is still sending: closing a
// socket with unread bytes resets the connection, which may discard the response.
void Session::linger() {
  channel_->end_sending();
  worker_.wait(*this, Phase::linger);
  await_bytes();
}

void Session::report(bool aborted) const {
  if (!outgoing_.begun()) return;
  const Response& response = outgoing_.response();
  const TokenEntry* token = grant_.token();
  observe({peer_.host, incoming_.request.method, incoming_.request.target, response.status,
           response.content_length(), Clock::now() - begun_, aborted, response.route, response.map,
           incoming_.request.method == "HEAD" ? 0 : frame_count(response),
           token == nullptr ? std::string_view() : token->name},
          shared_.metrics);
}

}  // namespace milepost::server
