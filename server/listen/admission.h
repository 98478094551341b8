// Counts connections, in all and by address, and decides which are served.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>

#include "server/listen/peer.h"

namespace milepost::server {

// Safe to use from several threads at once.
class Admission {
 public:
  enum class Verdict {
    serve,
    replace,  // serve it in place of the connection that has been idle for longest, or reject it
    reject,   // answer it with 503
    drop,     // close it: too many are being rejected already
  };

  // The place of a connection, free again when the object ends. Must not outlive the admission.
  class Ticket {
   public:
    Ticket(Admission& admission, Verdict verdict, const Peer& peer);
    Ticket(Ticket&& other) noexcept;
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;
    Ticket& operator=(Ticket&&) = delete;
    ~Ticket();
    Verdict verdict() const { return verdict_; }
    // Makes it the ticket of one that is rejected after all; of one that is dropped if too many are
    // rejected already.
    void reject();

   private:
    friend class Admission;
    Admission* admission_;
    Verdict verdict_;
    Peer::Key key_;
    bool counted_;
  };

  // REQUIRES: limits of at least 1.
  Admission(std::size_t connections, std::size_t per_address);

  Ticket enter(const Peer& peer);
  // More have been let in than are to be served: none should be accepted until places are free.
  bool overfull() const;
  // Those that are served, and those that are rejected.
  std::size_t count() const;

 private:
  Verdict verdict_for(const Peer& peer) const;
  Verdict rejection() const;
  void add(const Ticket& ticket);
  void remove(const Ticket& ticket);

  const std::size_t connections_;
  const std::size_t per_address_;
  const std::size_t rejections_;

  mutable std::mutex mutex_;
  std::size_t served_ = 0;                       // guarded by mutex_, like all below
  std::size_t rejected_ = 0;                     // being answered with 503
  std::map<Peer::Key, std::size_t> by_address_;  // those served
};

}  // namespace milepost::server
