// Accepts connections and hands them to the workers.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "server/http/worker.h"
#include "server/listen/listening_socket.h"
#include "server/listen/socket_address.h"

namespace milepost::server {

// Runs on the thread of the first worker.
class Listener {
 public:
  // REQUIRES: at least one worker. `shared` and the workers must outlive the listener.
  Listener(std::vector<ListeningSocket> sockets, Shared& shared,
           const std::vector<std::unique_ptr<Worker>>& workers);

  // Before the workers start.
  void start();
  // From any other thread, once, while the first worker runs: accepts what has connected, closes
  // the sockets and returns.
  void close();

 private:
  struct Door {
    Door(ListeningSocket opened, net::io_context& context)
        : socket(std::move(opened)), acceptor(context), pause(context) {}
    ListeningSocket socket;
    Acceptor acceptor;  // waits for connections of `socket`
    Timer pause;
  };

  void await(Door& door);
  void accept(Door& door);
  void pause(Door& door, std::chrono::milliseconds duration);
  bool accept_one(Door& door);
  void welcome(int descriptor, const SocketAddress& address, const Door& door);
  Worker& worker_for(Admission::Verdict verdict);
  void warn_of_rejection();

  Shared& shared_;
  const std::vector<std::unique_ptr<Worker>>& workers_;
  std::vector<std::unique_ptr<Door>> doors_;
  bool closed_ = false;  // handlers that are still to come do nothing
  std::size_t next_worker_ = 0;
  std::size_t rejected_ = 0;  // since the last warning
  Clock::time_point warned_;
};

}  // namespace milepost::server
