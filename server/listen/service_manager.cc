#include "server/listen/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace milepost::server {
namespace {

constexpr int kFirstInherited = 3;
constexpr int kMostInherited = 1024;

// The number that is all of an environment variable, or -1.
int number_in_environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr) return -1;
  const std::string_view text = value;
  int number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : -1;
}

}  // namespace

std::vector<int> inherited_descriptors() {
  const bool ours = number_in_environment("LISTEN_PID") == ::getpid();
  const int count = ours ? std::clamp(number_in_environment("LISTEN_FDS"), 0, kMostInherited) : 0;
  for (const char* name : {"LISTEN_PID", "LISTEN_FDS", "LISTEN_FDNAMES"}) ::unsetenv(name);
  std::vector<int> descriptors(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) descriptors[static_cast<std::size_t>(i)] = kFirstInherited + i;
  return descriptors;
}

Status notify_service_manager(const std::string& state) {
  const char* path = std::getenv("NOTIFY_SOCKET");
  if (path == nullptr || *path == '\0') return ok_status();
  const std::string_view text = path;
  sockaddr_un address{};
  const Error failed{ErrorCode::io, "NOTIFY_SOCKET " + std::string(text), "cannot be notified",
                     "correct the environment that the service manager sets"};
  if (text.size() >= sizeof(address.sun_path)) return failed;
  address.sun_family = AF_UNIX;
  std::copy(text.begin(), text.end(), std::begin(address.sun_path));
  if (text.front() == '@') address.sun_path[0] = '\0';  // the abstract name space
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return failed;
  const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + text.size());
  const ssize_t sent = ::sendto(socket, state.data(), state.size(), MSG_NOSIGNAL,
                                reinterpret_cast<const sockaddr*>(&address), bytes);
  ::close(socket);
  if (sent != static_cast<ssize_t>(state.size())) return failed;
  return ok_status();
}

}  // namespace milepost::server
