// The bytes of a connection, to and from its socket: as they are, or through TLS.
#pragma once

#include <sys/uio.h>

#include <cstddef>
#include <memory>
#include <span>

namespace milepost::server {

class TlsContext;

// What could be done without waiting.
struct Progress {
  enum class State {
    done,            // `bytes` of them
    needs_readable,  // the socket, before the same can be done
    needs_writable,  // the same
    ended,           // the connection, by the client or by an error
  };
  State state = State::done;
  std::size_t bytes = 0;
};

// Uses a socket that does not block, and never waits. Does not close the socket. Not safe to use
// from several threads at once.
class Channel {
 public:
  // Over bytes as they are. The socket must stay open while the channel is used, here and below.
  static std::unique_ptr<Channel> plain(int descriptor);
  // Through TLS, as its server; null if memory is short.
  static std::unique_ptr<Channel> tls(int descriptor, const TlsContext& context);

  // Agrees with the client on how bytes are sent, before any is: to be called until it is done.
  virtual Progress establish() = 0;
  // Sets bytes of `buffer` from its start, at least one if it is done.
  virtual Progress receive(std::span<char> buffer) = 0;
  // Sends bytes from the start of the pieces, at least one if it is done. After anything else the
  // next pieces must begin with the same bytes, and be no fewer.
  virtual Progress send(std::span<const iovec> pieces) = 0;
  // No bytes will be sent any more; some may still be received.
  virtual void end_sending() = 0;
  // There are bytes to receive, whether the socket is readable or not.
  virtual bool holds_bytes() const = 0;

  virtual ~Channel() = default;

 protected:
  Channel() = default;
  Channel(const Channel&) = default;
  Channel& operator=(const Channel&) = default;
};

}  // namespace milepost::server
