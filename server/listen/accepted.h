// A connection that was accepted, before a worker has it.
#pragma once

#include "server/listen/admission.h"
#include "server/listen/peer.h"

namespace milepost::server {

// Closed with the object.
class Accepted {
 public:
  // Takes the descriptor over. `of_family` is that of its address.
  Accepted(int descriptor, int of_family, bool is_tls, Peer from, Admission::Ticket place);
  Accepted(Accepted&& other) noexcept;
  Accepted& operator=(Accepted&&) = delete;
  Accepted(const Accepted&) = delete;
  Accepted& operator=(const Accepted&) = delete;
  ~Accepted();

  int release();  // the descriptor, which is the caller's then

  int family;
  bool through_tls;
  Peer peer;
  Admission::Ticket ticket;

 private:
  int descriptor_;
};

}  // namespace milepost::server
