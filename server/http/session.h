// One connection: handles its requests one after the other.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>

#include "server/catalog/current_catalog.h"
#include "server/http/asio.h"
#include "server/http/body_reader.h"
#include "server/http/request_parser.h"
#include "server/http/sessions.h"
#include "server/http/settings.h"
#include "server/message/response.h"

namespace milepost::server {

// A session runs on the strand of its socket, so its members need no lock.
// It keeps itself alive while it runs.
class Session : public std::enable_shared_from_this<Session> {
 public:
  enum class Service {
    serve,   // handles requests
    reject,  // answers the first request with 503: too many connections are open
  };

  // `socket` must run on a strand. `sessions` must outlive the session.
  Session(net::ip::tcp::socket socket, Service service,
          std::shared_ptr<const CurrentCatalog> catalog, const ConnectionLimits& limits,
          Sessions& sessions);

  void start();
  // May be called from any thread: closes after the response in progress, if any, is sent.
  void finish();
  // May be called from any thread: closes at once.
  void abort();

 private:
  net::awaitable<void> run();
  net::awaitable<bool> await_first_byte();
  net::awaitable<std::unique_ptr<Incoming>> read_request();
  net::awaitable<bool> read_more();
  net::awaitable<bool> answer(const Incoming& incoming);
  net::awaitable<bool> send(std::string_view head, ByteView first, BodyReader& rest);
  net::awaitable<bool> write(std::string_view head, ByteView body);
  net::awaitable<void> lingering_close();
  Response response_to(const Incoming& incoming) const;
  void close();

  const Service service_;
  const std::shared_ptr<const CurrentCatalog> catalog_;
  const ConnectionLimits limits_;
  Sessions& sessions_;
  std::string peer_;  // address, for the log

  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  bool waiting_ = false;    // for the client, with no request in progress
  bool finishing_ = false;  // no further request is read
};

}  // namespace milepost::server
