// A minimal client over a loopback socket: it sends exactly the bytes of a test.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace milepost::server {

struct Reply {
  int status = 0;                              // 0: the connection ended before a complete header
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;                            // as much as was received
  bool whole = false;                          // the body has the stated length

  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

// Throws if the socket fails; reading gives up after 60 s.
class Connection {
 public:
  Connection();  // a socket that is not connected yet
  explicit Connection(std::uint16_t port, int receive_buffer_bytes = 0);
  // From another address of this host's own, such as 127.0.0.2.
  Connection(std::uint16_t port, const char* source);
  explicit Connection(const std::filesystem::path& unix_socket);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool connect(std::uint16_t port);
  // No more bytes will be sent.
  void end_sending();
  // Closes so that the peer receives a reset.
  void reset();
  // False if the peer has closed.
  bool send(std::string_view bytes);
  void send_get(const std::string& target, const std::string& more_headers = "");
  // The next response; one to HEAD or 304 has no body.
  Reply receive(bool to_head = false);
  // Whether the peer closes without sending another byte.
  bool closed();
  int descriptor() const { return socket_; }
  // Some bytes, up to `count`; fewer only when the peer has closed.
  std::string read(std::size_t count);

 private:
  explicit Connection(int socket);
  bool fill();

  int socket_;
  std::string buffer_;
};

// One request on a connection of its own.
Reply fetch(std::uint16_t port, const std::string& target, const std::string& more_headers = "");

}  // namespace milepost::server
