#include "server/listen/listening_socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "server/listen/socket_address.h"

namespace milepost::server {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

Error cannot_listen(const std::string& where, int error) {
  return {ErrorCode::io, where, "cannot be listened on (" + reason(error) + ")",
          "choose another address or port, or end the program that uses it"};
}

// The addresses of a host. Errors: invalid_input.
Result<std::vector<SocketAddress>> resolved(const ListenAddress& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* list = nullptr;
  const std::string port = std::to_string(address.port);
  const int failed = ::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &list);
  if (failed != 0) {
    return Error{ErrorCode::invalid_input, "address " + address.host,
                 std::string("cannot be resolved (") + ::gai_strerror(failed) + ")",
                 "write an address as numbers, such as 127.0.0.1 or ::1, or a name that resolves"};
  }
  std::vector<SocketAddress> addresses;
  for (const addrinfo* one = list; one != nullptr; one = one->ai_next) {
    SocketAddress found;
    std::copy_n(reinterpret_cast<const char*>(one->ai_addr), one->ai_addrlen,
                reinterpret_cast<char*>(&found.storage));
    found.bytes = one->ai_addrlen;
    addresses.push_back(found);
  }
  ::freeaddrinfo(list);
  return addresses;
}

// 0, or the error number.
int listen_on(int descriptor, const SocketAddress& address) {
  const int on = 1;
  if (!address.is_unix()) {
    ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  }
  if (::bind(descriptor, address.data(), address.bytes) != 0) return errno;
  return ::listen(descriptor, SOMAXCONN) == 0 ? 0 : errno;
}

int stream_socket(int family) {
  return ::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

// This system has no such address at all, as where IPv6 is switched off.
bool is_absent(int error) { return error == EAFNOSUPPORT || error == EADDRNOTAVAIL; }

// Removes the file of a unix socket that nobody listens on.
void remove_stale_socket(const SocketAddress& address, const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode)) return;
  const int probe = stream_socket(AF_UNIX);
  const bool refused =
      ::connect(probe, address.data(), address.bytes) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  if (refused) ::unlink(path.c_str());
}

int socket_option(int descriptor, int option) {
  int value = 0;
  socklen_t bytes = sizeof(value);
  return ::getsockopt(descriptor, SOL_SOCKET, option, &value, &bytes) == 0 ? value : -1;
}

}  // namespace

Result<std::vector<ListeningSocket>> ListeningSocket::open(const ListenAddress& address) {
  std::vector<ListeningSocket> sockets;
  if (!address.unix_path.empty()) {
    Result<ListeningSocket> socket = open_unix(address.unix_path);
    if (!socket) return socket.error();
    sockets.push_back(std::move(socket).value());
    return sockets;
  }
  Result<std::vector<SocketAddress>> addresses = resolved(address);
  if (!addresses) return addresses.error();
  Status absent = ok_status();
  for (SocketAddress& one : *addresses) {
    if (address.port == 0 && !sockets.empty()) one.set_port(sockets.front().port());
    ListeningSocket socket(stream_socket(one.storage.ss_family));
    const int error = socket.descriptor_ < 0 ? errno : listen_on(socket.descriptor_, one);
    if (error != 0) {
      if (!is_absent(error)) return cannot_listen(one.text(), error);
      absent = cannot_listen(one.text(), error);
      continue;
    }
    socket.name();
    socket.plain_ = address.plain;
    sockets.push_back(std::move(socket));
  }
  if (sockets.empty()) return absent.error();
  return sockets;
}

Result<ListeningSocket> ListeningSocket::open_unix(const std::string& path) {
  SocketAddress address;
  auto& name = reinterpret_cast<sockaddr_un&>(address.storage);
  name.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), std::begin(name.sun_path));
  address.bytes = sizeof(sockaddr_un);
  remove_stale_socket(address, path);
  ListeningSocket socket(stream_socket(AF_UNIX));
  const int error = socket.descriptor_ < 0 ? errno : listen_on(socket.descriptor_, address);
  if (error != 0) return cannot_listen(address.text(), error);
  socket.created_path_ = path;
  socket.name();
  return socket;
}

Result<ListeningSocket> ListeningSocket::inherited(int descriptor) {
  if (socket_option(descriptor, SO_TYPE) != SOCK_STREAM ||
      socket_option(descriptor, SO_ACCEPTCONN) != 1) {
    return Error{ErrorCode::invalid_input, "descriptor " + std::to_string(descriptor),
                 "is not a listening stream socket", "correct the unit of the service manager"};
  }
  ListeningSocket socket(descriptor);
  ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
  socket.name();
  return socket;
}

ListeningSocket::ListeningSocket(int descriptor) : descriptor_(descriptor) {}

ListeningSocket::ListeningSocket(ListeningSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      address_(std::move(other.address_)),
      port_(other.port_),
      plain_(other.plain_),
      created_path_(std::exchange(other.created_path_, {})) {}

ListeningSocket& ListeningSocket::operator=(ListeningSocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(address_, other.address_);
  std::swap(port_, other.port_);
  std::swap(plain_, other.plain_);
  std::swap(created_path_, other.created_path_);
  return *this;
}

ListeningSocket::~ListeningSocket() {
  if (!created_path_.empty()) ::unlink(created_path_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
}

// Takes its address from the system, with the actual port.
void ListeningSocket::name() {
  SocketAddress address;
  ::getsockname(descriptor_, address.data(), &address.bytes);
  address_ = address.text();
  port_ = address.port();
  plain_ = address.is_unix();
}

}  // namespace milepost::server
