#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "server/channel/channel.h"
#include "server/channel/tls_context.h"

namespace milepost::server {
namespace {

constexpr std::size_t kRecordBytes = 16'384;  // the most of one record (RFC 8446, section 5.1)

// OpenSSL's own socket raises SIGPIPE when the client is gone. This one takes the socket from an
// int, its data.
int socket_of(BIO* bio) { return *static_cast<const int*>(BIO_get_data(bio)); }

int write_to_socket(BIO* bio, const char* bytes, int count) {
  BIO_clear_retry_flags(bio);
  const ssize_t sent = ::send(socket_of(bio), bytes, static_cast<std::size_t>(count), MSG_NOSIGNAL);
  if (sent < 0 && (errno == EAGAIN || errno == EINTR)) BIO_set_retry_write(bio);
  return static_cast<int>(sent);
}

int read_from_socket(BIO* bio, char* bytes, int count) {
  BIO_clear_retry_flags(bio);
  const ssize_t received = ::recv(socket_of(bio), bytes, static_cast<std::size_t>(count), 0);
  if (received < 0 && (errno == EAGAIN || errno == EINTR)) BIO_set_retry_read(bio);
  return static_cast<int>(received);
}

// Nothing is held back, so there is nothing to flush; no other question has an answer.
long control_socket(BIO* /*bio*/, int command, long /*number*/, void* /*pointer*/) {
  return command == BIO_CTRL_FLUSH ? 1 : 0;
}

const BIO_METHOD* socket_method() {
  static const BIO_METHOD* const method = [] {
    BIO_METHOD* made = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "socket");
    BIO_meth_set_write(made, write_to_socket);
    BIO_meth_set_read(made, read_from_socket);
    BIO_meth_set_ctrl(made, control_socket);
    return made;
  }();
  return method;
}

// Bytes of the pieces, from their start, that fit a record: a view of the first piece if that fills
// one, else copies in `room`.
std::span<const char> next_record(std::span<const iovec> pieces,
                                  std::array<char, kRecordBytes>& room) {
  const iovec& first = pieces.front();
  if (first.iov_len >= kRecordBytes || pieces.size() == 1) {
    return {static_cast<const char*>(first.iov_base), std::min(first.iov_len, kRecordBytes)};
  }
  std::size_t bytes = 0;
  for (const iovec& piece : pieces) {
    const std::size_t part = std::min(piece.iov_len, kRecordBytes - bytes);
    std::copy_n(static_cast<const char*>(piece.iov_base), part, room.data() + bytes);
    bytes += part;
    if (bytes == kRecordBytes) break;
  }
  return {room.data(), bytes};
}

// Removes sent bytes from the start of the pieces.
void remove_front(std::span<iovec>& pieces, std::size_t bytes) {
  while (bytes > 0) {
    iovec& first = pieces.front();
    const std::size_t part = std::min(bytes, first.iov_len);
    first.iov_base = static_cast<char*>(first.iov_base) + part;
    first.iov_len -= part;
    bytes -= part;
    if (first.iov_len == 0) pieces = pieces.subspan(1);
  }
}

class TlsChannel final : public Channel {
 public:
  // Takes the session over.
  TlsChannel(int descriptor, SSL* session) : descriptor_(descriptor), session_(session) {}
  TlsChannel(const TlsChannel&) = delete;
  TlsChannel& operator=(const TlsChannel&) = delete;
  ~TlsChannel() override {
    SSL_free(session_);
    ERR_clear_error();
  }

  // False if memory is short.
  bool attach() {
    BIO* bio = BIO_new(socket_method());
    if (bio == nullptr) return false;
    BIO_set_data(bio, &descriptor_);
    BIO_set_init(bio, 1);
    SSL_set_bio(session_, bio, bio);
    SSL_set_accept_state(session_);
    return true;
  }

  Progress establish() override {
    ERR_clear_error();
    const int result = SSL_do_handshake(session_);
    return result == 1 ? Progress{} : without_bytes(result);
  }

  Progress receive(std::span<char> buffer) override {
    Progress progress;
    while (progress.bytes < buffer.size()) {
      const auto room = buffer.subspan(progress.bytes);
      std::size_t bytes = 0;
      ERR_clear_error();
      const int result = SSL_read_ex(session_, room.data(), room.size(), &bytes);
      if (result != 1 && progress.bytes > 0) break;  // the next call tells why
      if (result != 1) return without_bytes(result);
      progress.bytes += bytes;
    }
    return progress;
  }

  Progress send(std::span<const iovec> all) override {
    std::array<iovec, 64> rest;
    const std::size_t count = std::min(all.size(), rest.size());
    std::copy_n(all.begin(), count, rest.begin());
    std::span<iovec> pieces(rest.data(), count);
    std::array<char, kRecordBytes> room;
    Progress progress;
    while (!pieces.empty()) {
      const auto record = next_record(pieces, room);
      std::size_t bytes = 0;
      ERR_clear_error();
      const int result = SSL_write_ex(session_, record.data(), record.size(), &bytes);
      if (result != 1 && progress.bytes > 0) break;
      if (result != 1) return without_bytes(result);
      progress.bytes += bytes;
      remove_front(pieces, bytes);
    }
    return progress;
  }

  void end_sending() override {
    ERR_clear_error();
    SSL_shutdown(session_);  // its alert is lost if there is no room for it, as the connection ends
    ERR_clear_error();
    ::shutdown(descriptor_, SHUT_WR);
  }

  // Also the end of what the client sends, which the socket does not show again.
  bool holds_bytes() const override {
    return SSL_pending(session_) > 0 || (SSL_get_shutdown(session_) & SSL_RECEIVED_SHUTDOWN) != 0;
  }

 private:
  Progress without_bytes(int result) const {
    switch (SSL_get_error(session_, result)) {
      case SSL_ERROR_WANT_READ:
        return {Progress::State::needs_readable};
      case SSL_ERROR_WANT_WRITE:
        return {Progress::State::needs_writable};
      default:
        return {Progress::State::ended};
    }
  }

  int descriptor_;
  SSL* const session_;
};

}  // namespace

std::unique_ptr<Channel> Channel::tls(int descriptor, const TlsContext& context) {
  SSL* const session = SSL_new(context.native());
  if (session == nullptr) return nullptr;
  auto channel = std::make_unique<TlsChannel>(descriptor, session);
  if (!channel->attach()) return nullptr;
  return channel;
}

}  // namespace milepost::server
