#include "server/access/access.h"

#include <string>

namespace milepost::server {

Grant Access::grant(std::string_view authorization) const {
  if (tokens_ == nullptr) return Grant::everything();
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return tokens_->now()->grant(authorization, now);
}

std::chrono::steady_clock::duration Access::wait(const Grant& grant, const Peer& peer) {
  const auto now = RateLimit::Clock::now();
  if (!rate_.is_limited()) return {};
  if (grant.token() != nullptr) return rate_.wait(grant.token()->id, now);
  if (!peer.counted) return {};
  return rate_.wait({reinterpret_cast<const char*>(peer.key.data()), peer.key.size()}, now);
}

Response too_many_requests(std::chrono::steady_clock::duration wait) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(wait).count();
  Response response = problem(429, "too many requests come from this client; ask less often");
  response.headers.emplace_back("Retry-After", std::to_string(seconds));
  return response;
}

}  // namespace milepost::server
