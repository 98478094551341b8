#include "server/listen/accepted.h"

#include <unistd.h>

#include <utility>

namespace milepost::server {

Accepted::Accepted(int descriptor, int of_family, bool is_tls, Peer from, Admission::Ticket place)
    : family(of_family),
      through_tls(is_tls),
      peer(std::move(from)),
      ticket(std::move(place)),
      descriptor_(descriptor) {}

Accepted::Accepted(Accepted&& other) noexcept
    : family(other.family),
      through_tls(other.through_tls),
      peer(std::move(other.peer)),
      ticket(std::move(other.ticket)),
      descriptor_(other.release()) {}

Accepted::~Accepted() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int Accepted::release() { return std::exchange(descriptor_, -1); }

}  // namespace milepost::server
