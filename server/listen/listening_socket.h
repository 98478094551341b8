// Sockets that wait for connections.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schema/base/result.h"
#include "server/listen/listen_address.h"

namespace milepost::server {

// A listening socket, not blocking and not inherited by other programs; closed with the object,
// which also removes the file of a unix socket that it created.
class ListeningSocket {
 public:
  // One socket for each address of the host; addresses that this system does not have are skipped
  // if there are others. With port 0 all get the same free port. The file of a unix socket that
  // nobody listens on any more is replaced. Errors: invalid_input (the host cannot be resolved), io
  // (an address is in use, not ours, not permitted).
  static Result<std::vector<ListeningSocket>> open(const ListenAddress& address);
  // A socket that another program opened, such as a service manager; takes the descriptor over.
  // Errors: invalid_input (not a listening stream socket).
  static Result<ListeningSocket> inherited(int descriptor);

  ListeningSocket(ListeningSocket&& other) noexcept;
  ListeningSocket& operator=(ListeningSocket&& other) noexcept;
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;
  ~ListeningSocket();

  int descriptor() const { return descriptor_; }
  const std::string& address() const { return address_; }  // "127.0.0.1:8080", "unix:/path"
  std::uint16_t port() const { return port_; }             // 0 for a unix socket
  bool plain() const { return plain_; }                    // never TLS: a unix socket, or so chosen

 private:
  explicit ListeningSocket(int descriptor);
  static Result<ListeningSocket> open_unix(const std::string& path);
  void name();

  int descriptor_ = -1;
  std::string address_;
  std::uint16_t port_ = 0;
  bool plain_ = false;
  std::string created_path_;  // of a unix socket
};

}  // namespace milepost::server
