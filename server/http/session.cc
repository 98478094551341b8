#include "server/http/session.h"

#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <exception>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include "server/http/head.h"
#include "server/routes/handle.h"

namespace milepost::server {
namespace {

constexpr std::size_t kReadBytes = 4096;
constexpr std::size_t kWriteBytes = 65536;       // per write; a client has `stall` to take it
constexpr std::size_t kLingerBytes = 1'048'576;  // discarded at most from a client

std::string_view text_of(const net::const_buffer& buffer) {
  return {static_cast<const char*>(buffer.data()), buffer.size()};
}

}  // namespace

Session::Session(net::ip::tcp::socket socket, Service service,
                 std::shared_ptr<const CurrentCatalog> catalog, const ConnectionLimits& limits,
                 Sessions& sessions)
    : service_(service),
      catalog_(std::move(catalog)),
      limits_(limits),
      sessions_(sessions),
      stream_(std::move(socket)) {
  error_code ignored;  // a disconnected peer has no address
  peer_ = stream_.socket().remote_endpoint(ignored).address().to_string();
  stream_.socket().set_option(net::ip::tcp::no_delay(true), ignored);
}

void Session::start() {
  if (!sessions_.add(shared_from_this())) return;  // the server is stopping
  const auto run_self = [self = shared_from_this()] { return self->run(); };
  const auto when_done = [self = shared_from_this()](const std::exception_ptr& failure) {
    if (failure) spdlog::error("{}: a session ended by an exception", self->peer_);
    self->close();
    self->sessions_.remove(self.get());
  };
  net::co_spawn(stream_.get_executor(), run_self, when_done);
}

void Session::finish() {
  net::post(stream_.get_executor(), [self = shared_from_this()] {
    self->finishing_ = true;
    if (self->waiting_) self->close();
  });
}

void Session::abort() {
  net::post(stream_.get_executor(), [self = shared_from_this()] {
    self->finishing_ = true;
    self->close();
  });
}

void Session::close() { stream_.close(); }

net::awaitable<void> Session::run() {
  while (!finishing_) {
    const bool begun = co_await await_first_byte();
    if (!begun) co_return;
    const std::unique_ptr<Incoming> incoming = co_await read_request();
    if (incoming == nullptr) co_return;
    const bool open = co_await answer(*incoming);
    if (!open) break;
  }
  co_await lingering_close();
}

// Between requests a client may be idle for longer than within one.
net::awaitable<bool> Session::await_first_byte() {
  if (buffer_.size() > 0) co_return true;  // the next request arrived with the last one
  waiting_ = true;
  stream_.expires_after(limits_.idle);
  const bool more = co_await read_more();
  waiting_ = false;
  co_return more;
}

// Null if the connection ended or timed out: no response is sent.
net::awaitable<std::unique_ptr<Incoming>> Session::read_request() {
  RequestParser parser(limits_);
  stream_.expires_after(limits_.request);  // for the whole request
  while (true) {
    buffer_.consume(parser.take(text_of(buffer_.cdata())));
    if (parser.done()) co_return std::make_unique<Incoming>(parser.incoming());
    const bool more = co_await read_more();
    if (!more) co_return nullptr;
  }
}

// Reads more bytes from the client. False if there are none.
net::awaitable<bool> Session::read_more() {
  error_code error;
  const auto space = buffer_.prepare(kReadBytes);
  const std::size_t bytes = co_await stream_.async_read_some(space, awaited(error));
  buffer_.commit(bytes);
  co_return !error;
}

Response Session::response_to(const Incoming& incoming) const {
  if (service_ == Service::reject) {
    return problem(503, "too many connections are open; try again later");
  }
  if (incoming.refusal) return *incoming.refusal;
  try {
    return handle(incoming.request, *catalog_->now());
  } catch (const std::exception& failure) {
    spdlog::error("{} {}: {}", incoming.request.method, incoming.request.target, failure.what());
    return problem(500, "the server failed on this request; its log says why");
  }
}

// Returns whether the connection stays open for another request.
net::awaitable<bool> Session::answer(const Incoming& incoming) {
  const auto begun = std::chrono::steady_clock::now();
  const bool body_wanted = incoming.request.method != "HEAD";
  Response response = response_to(incoming);
  BodyReader body(response, body_wanted);
  Result<ByteView> first = body.next();
  if (!first) {  // nothing is sent yet, so the status can still be 500
    spdlog::error("{}", first.error().line());
    response = problem(500, "the map cannot be read; the server's log says why");
    body = BodyReader(response, body_wanted);
    first = body.next();
  }
  const bool keep_alive = incoming.keep_alive && !finishing_ && service_ == Service::serve;
  const std::string head = head_of(response, incoming.http_version, keep_alive);
  const bool sent = co_await send(head, *first, body);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begun;
  spdlog::info("{} \"{} {}\" {} {} bytes {:.1f} ms{}", peer_, incoming.request.method,
               incoming.request.target, response.status, response.content_length(), took.count(),
               sent ? "" : ", aborted");
  co_return sent&& keep_alive;
}

// False if the response was aborted; the connection is then closed, so that the client detects the
// missing bytes.
net::awaitable<bool> Session::send(std::string_view head, ByteView first, BodyReader& rest) {
  bool sent = co_await write(head, first);
  while (sent && !rest.done()) {
    const Result<ByteView> piece = rest.next();
    if (!piece) spdlog::error("{}", piece.error().line());
    sent = piece.ok();
    if (sent) sent = co_await write({}, *piece);
  }
  if (!sent) close();
  co_return sent;
}

net::awaitable<bool> Session::write(std::string_view head, ByteView body) {
  do {
    const ByteView part = body.first(std::min(body.size(), kWriteBytes));
    const std::array<net::const_buffer, 2> buffers = {net::buffer(head.data(), head.size()),
                                                      net::buffer(part.data(), part.size())};
    error_code error;
    stream_.expires_after(limits_.stall);
    co_await net::async_write(stream_, buffers, awaited(error));
    if (error) co_return false;
    head = {};
    body = body.subspan(part.size());
  } while (!body.empty());
  co_return true;
}

// Closes so that the client receives the last response even if it is still sending: closing a
// socket with unread bytes resets the connection, which may discard the response.
net::awaitable<void> Session::lingering_close() {
  error_code error;
  stream_.socket().shutdown(net::ip::tcp::socket::shutdown_send, error);
  waiting_ = true;
  stream_.expires_after(limits_.lingering_close);
  std::array<char, kReadBytes> discarded{};
  std::size_t total = 0;
  while (!error && !finishing_ && total < kLingerBytes) {
    total += co_await stream_.async_read_some(net::buffer(discarded), awaited(error));
  }
}

}  // namespace milepost::server
