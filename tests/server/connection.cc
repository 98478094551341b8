#include "tests/server/connection.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

namespace milepost::server {
namespace {

void parse_head(const std::string& head, Reply& reply) {
  std::istringstream lines(head);
  std::string line;
  std::getline(lines, line);
  if (line.starts_with("HTTP/1.")) reply.status = std::stoi(line.substr(9, 3));
  while (std::getline(lines, line) && line != "\r") {
    const std::size_t colon = line.find(": ");
    std::string name = line.substr(0, colon);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return static_cast<char>(std::tolower(c)); });
    reply.headers[name] = line.substr(colon + 2, line.size() - colon - 3);
  }
}

}  // namespace

Connection::Connection() : Connection(::socket(AF_INET, SOCK_STREAM, 0)) {}

Connection::Connection(int socket) : socket_(socket) {
  const timeval patience{60, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
}

Connection::Connection(std::uint16_t port, int receive_buffer_bytes) : Connection() {
  if (receive_buffer_bytes > 0) {
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes,
                 sizeof(receive_buffer_bytes));
  }
  if (!connect(port)) throw std::runtime_error("cannot connect");
}

Connection::Connection(std::uint16_t port, const char* source) : Connection() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  inet_pton(AF_INET, source, &address.sin_addr);
  ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  if (!connect(port)) throw std::runtime_error("cannot connect");
}

Connection::Connection(const std::filesystem::path& unix_socket)
    : Connection(::socket(AF_UNIX, SOCK_STREAM, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = unix_socket;
  std::copy(path.begin(), path.end(), std::begin(address.sun_path));
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw std::runtime_error("cannot connect");
  }
}

void Connection::end_sending() { ::shutdown(socket_, SHUT_WR); }

void Connection::reset() {
  const linger at_once{1, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
  ::close(socket_);
  socket_ = -1;
}

bool Connection::connect(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

Connection::~Connection() { ::close(socket_); }

bool Connection::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

void Connection::send_get(const std::string& target, const std::string& more_headers) {
  send("GET " + target + " HTTP/1.1\r\nHost: test\r\n" + more_headers + "\r\n");
}

bool Connection::fill() {
  std::array<char, 65536> bytes{};
  const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
  if (count < 0 && errno == EAGAIN) throw std::runtime_error("the server keeps silent");
  if (count <= 0) return false;
  buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

std::string Connection::read(std::size_t count) {
  while (buffer_.size() < count && fill()) {
  }
  std::string bytes = buffer_.substr(0, count);
  buffer_.erase(0, bytes.size());
  return bytes;
}

Reply Connection::receive(bool to_head) {
  Reply reply;
  while (buffer_.find("\r\n\r\n") == std::string::npos) {
    if (!fill()) return reply;
  }
  const std::size_t end = buffer_.find("\r\n\r\n") + 4;
  parse_head(buffer_.substr(0, end), reply);
  buffer_.erase(0, end);
  const auto length = reply.headers.find("content-length");
  const std::size_t promised =
      to_head || length == reply.headers.end() ? 0 : std::stoul(length->second);
  reply.body = read(promised);
  reply.whole = reply.body.size() == promised;
  return reply;
}

bool Connection::closed() { return buffer_.empty() && !fill(); }

Reply fetch(std::uint16_t port, const std::string& target, const std::string& more_headers) {
  Connection connection(port);
  connection.send_get(target, more_headers);
  return connection.receive();
}

}  // namespace milepost::server
