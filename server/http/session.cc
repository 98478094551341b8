#include "server/http/session.h"

#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <exception>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/handle.h"
#include "server/http/head.h"

namespace milepost::server {
namespace http = boost::beast::http;
namespace {

using Parser = http::request_parser<http::string_body>;

constexpr std::size_t kReadBytes = 4096;
constexpr std::size_t kWriteBytes = 65536;       // a client has `stall` to take so much
constexpr std::size_t kLingerBytes = 1'048'576;  // of what a refused client goes on sending

std::string all_values(const Parser& parser, http::field name) {
  std::string joined;
  const auto [begin, end] = parser.get().equal_range(name);
  for (auto field = begin; field != end; ++field) {
    joined.append(joined.empty() ? "" : ", ").append(std::string(field->value()));
  }
  return joined;
}

// The answer to bytes that are no request of ours.
Response refusal_of(const error_code& error, const Parser& parser) {
  if (error == http::error::body_limit) {
    return problem(413, "the request's body is too long; no address of this server takes one");
  }
  if (error == http::error::header_limit) {
    return parser.get().target().empty()
               ? problem(414, "the request's first line is too long; shorten the address")
               : problem(431, "the request's header is too long; send fewer or shorter fields");
  }
  return problem(400, "this is no HTTP/1.1 request (" + error.message() + "); mend the client");
}

bool is_http_error(const error_code& error) {
  return error && error.category() == make_error_code(http::error::bad_method).category() &&
         error != http::error::end_of_stream && error != http::error::partial_message;
}

}  // namespace

Session::Session(net::ip::tcp::socket socket, Service service,
                 std::shared_ptr<const Catalog> catalog, const ConnectionLimits& limits,
                 Sessions& sessions)
    : service_(service),
      catalog_(std::move(catalog)),
      limits_(limits),
      sessions_(sessions),
      stream_(std::move(socket)) {
  error_code ignored;  // a peer that is gone already has no address
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
  co_await linger();
}

// Between requests a client may be silent for longer than within one.
net::awaitable<bool> Session::await_first_byte() {
  if (buffer_.size() > 0) co_return true;  // the next request came together with the last one
  error_code error;
  waiting_ = true;
  stream_.expires_after(limits_.idle);
  const auto space = buffer_.prepare(kReadBytes);
  const std::size_t bytes = co_await stream_.async_read_some(space, awaited(error));
  waiting_ = false;
  buffer_.commit(bytes);
  co_return !error;
}

// Null if the connection ended or was too slow: there is nobody to answer.
net::awaitable<std::unique_ptr<Session::Incoming>> Session::read_request() {
  Parser parser;
  parser.header_limit(static_cast<std::uint32_t>(limits_.header_bytes));
  parser.body_limit(limits_.body_bytes);
  error_code error;
  stream_.expires_after(limits_.request);  // for all of it, however it drips in
  co_await http::async_read(stream_, buffer_, parser, awaited(error));
  auto incoming = std::make_unique<Incoming>();
  if (is_http_error(error)) {
    incoming->refusal = std::make_unique<Response>(refusal_of(error, parser));
    co_return incoming;
  }
  if (error) co_return nullptr;
  const auto& message = parser.get();
  incoming->request.method = std::string(message.method_string());
  incoming->request.target = std::string(message.target());
  incoming->request.if_none_match = all_values(parser, http::field::if_none_match);
  incoming->http_version = message.version();
  incoming->keep_alive = message.keep_alive();
  if (message.version() == 11 && message.count(http::field::host) != 1) {
    incoming->keep_alive = false;
    incoming->refusal = std::make_unique<Response>(
        problem(400, "the request needs one Host field; mend the client"));
  }
  co_return incoming;
}

Response Session::response_to(const Incoming& incoming) const {
  if (service_ == Service::turn_away) {
    return problem(503, "too many connections are open; try again later");
  }
  if (incoming.refusal != nullptr) return *incoming.refusal;
  try {
    return handle(incoming.request, *catalog_);
  } catch (const std::exception& failure) {
    spdlog::error("{} {}: {}", incoming.request.method, incoming.request.target, failure.what());
    return problem(500, "the server failed on this request; its log says why");
  }
}

// Whether the connection can take another request.
net::awaitable<bool> Session::answer(const Incoming& incoming) {
  const auto begun = std::chrono::steady_clock::now();
  const bool body_wanted = incoming.request.method != "HEAD";
  Response response = response_to(incoming);
  BodyReader body(response, body_wanted);
  Result<ByteView> first = body.next();
  if (!first) {  // nothing is sent yet, so the client can still be told
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
               sent ? "" : ", broken off");
  co_return sent&& keep_alive;
}

// False if the answer was broken off; the connection is then closed, so that the client sees that
// bytes are missing.
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

// Closes so that the client gets the last answer even if it is still sending: a socket that is
// closed with unread bytes is reset, and the answer with it.
net::awaitable<void> Session::linger() {
  error_code error;
  stream_.socket().shutdown(net::ip::tcp::socket::shutdown_send, error);
  waiting_ = true;
  stream_.expires_after(limits_.linger);
  std::array<char, kReadBytes> discarded{};
  std::size_t total = 0;
  while (!error && !finishing_ && total < kLingerBytes) {
    total += co_await stream_.async_read_some(net::buffer(discarded), awaited(error));
  }
}

}  // namespace milepost::server
