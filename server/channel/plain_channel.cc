#include <sys/socket.h>

#include <cerrno>

#include "server/channel/channel.h"

namespace milepost::server {
namespace {

Progress progress_of(ssize_t bytes, Progress::State otherwise) {
  if (bytes > 0) return {Progress::State::done, static_cast<std::size_t>(bytes)};
  if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return {otherwise};
  return {Progress::State::ended};
}

class PlainChannel final : public Channel {
 public:
  explicit PlainChannel(int descriptor) : descriptor_(descriptor) {}

  Progress establish() override { return {}; }

  Progress receive(std::span<char> buffer) override {
    return progress_of(::recv(descriptor_, buffer.data(), buffer.size(), 0),
                       Progress::State::needs_readable);
  }

  Progress send(std::span<const iovec> pieces) override {
    msghdr message{};
    // Sending does not change them. NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    message.msg_iov = const_cast<iovec*>(pieces.data());
    message.msg_iovlen = pieces.size();
    return progress_of(::sendmsg(descriptor_, &message, MSG_NOSIGNAL),
                       Progress::State::needs_writable);
  }

  void end_sending() override { ::shutdown(descriptor_, SHUT_WR); }

  bool holds_bytes() const override { return false; }

 private:
  const int descriptor_;
};

}  // namespace

std::unique_ptr<Channel> Channel::plain(int descriptor) {
  return std::make_unique<PlainChannel>(descriptor);
}

}  // namespace milepost::server
