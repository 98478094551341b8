// Who may ask for what, and how often.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "server/access/grant.h"
#include "server/access/rate_limit.h"
#include "server/access/tokens.h"
#include "server/listen/peer.h"
#include "server/message/response.h"

namespace milepost::server {

// Safe to use from several threads at once.
class Access {
 public:
  // `tokens`: null where everybody may ask for everything.
  Access(std::shared_ptr<const CurrentTokens> tokens, const RateSettings& rate)
      : tokens_(std::move(tokens)), rate_(rate) {}

  bool asks_for_tokens() const { return tokens_ != nullptr; }
  // For the value of a request's Authorization, empty if absent.
  Grant grant(std::string_view authorization) const;
  // The time that a client has to wait before it may ask; zero counts as a request. A client is a
  // valid token, or else an address; a proxy on a unix socket has no limit of its own.
  std::chrono::steady_clock::duration wait(const Grant& grant, const Peer& peer);

 private:
  const std::shared_ptr<const CurrentTokens> tokens_;
  RateLimit rate_;
};

// 429, after which the client has to wait.
Response too_many_requests(std::chrono::steady_clock::duration wait);

}  // namespace milepost::server
