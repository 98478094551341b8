// One connection: answers its requests one after the other.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/channel/channel.h"
#include "server/http/answering.h"
#include "server/http/exchange.h"
#include "server/http/outgoing.h"
#include "server/http/request_reader.h"
#include "server/http/worker.h"

namespace milepost::server {

// Lives on the thread of its worker; what waits for it (a socket, the disk) keeps it alive.
//
//   establish -> receive -> serve: the next request -> answer (from memory, or wait for the disk)
//   -> send -> serve
//
// At any time it waits for its client, or for the disk, or for both while it reads ahead.
class Session final : public Waiting, public std::enable_shared_from_this<Session> {
 public:
  // `worker` must outlive the session.
  Session(Worker& worker, Accepted accepted);

  void start();
  // Answers 503, then closes.
  void reject();
  void expire() override;
  bool has_bytes() const override;
  void close() override;

 private:
  void open_channel(const Accepted& accepted);
  void establish();
  void end_establishing();

  void await_readable();
  void await_writable();
  void on_readable();
  void on_writable();

  void await_bytes();
  void receive();
  void discard(std::size_t bytes);
  void serve();
  void await_request();

  void answer();
  void answer_later();
  void refuse(PreparedAnswer answer);
  void respond(Answer answer);

  void send();
  bool send_some();
  void await_room();
  void add_hot_frames();
  void read_ahead();
  void add_frames(Result<std::vector<Frame>> frames);
  void end_response();
  void linger();
  void report(bool aborted) const;

  Worker& worker_;
  Shared& shared_;
  Socket socket_;
  std::unique_ptr<Channel> channel_;  // over the socket
  const Peer peer_;
  const Admission::Ticket ticket_;
  RequestReader reader_;
  Incoming incoming_;                     // the request that is being answered
  Grant grant_ = Grant::without_token();  // of it
  Outgoing outgoing_;
  Clock::time_point begun_;          // when the request was complete
  std::size_t sent_bytes_ = 0;       // of a response, since its deadline was set
  std::size_t discarded_bytes_ = 0;  // after the last response
  bool established_ = false;         // the channel
  bool rejected_ = false;            // is answered with 503, whatever it asks for
  bool awaiting_readable_ = false;   // the socket
  bool awaiting_writable_ = false;   // the same
  bool reading_ = false;             // frames, from the disk
  bool in_request_ = false;          // some bytes of the next request are there
  bool responding_ = false;          // from a whole request to the end of its response
  bool keep_alive_ = false;          // after this response
  bool broken_ = false;              // the rest of the body cannot be read
  bool closed_ = false;
};

}  // namespace milepost::server
