#include "server/routes/guard.h"

#include <string>

namespace milepost::server {
namespace {

// RFC 6750, section 3.
Response unauthorized(const Grant& grant) {
  std::string detail = "a token is needed; send 'Authorization: Bearer TOKEN'";
  std::string challenge = R"(Bearer realm="milepost")";
  if (grant.is_of_bad_token()) {
    detail = grant.is_of_expired_token() ? "the token has expired; ask the operator for another one"
                                         : "the token is not known; check that it is complete";
    challenge += R"(, error="invalid_token")";
  }
  Response response = problem(401, detail);
  response.headers.emplace_back("WWW-Authenticate", challenge);
  return response;
}

Response forbidden() {
  Response response = problem(403, "the token is not for this; ask the operator for another one");
  response.headers.emplace_back("WWW-Authenticate",
                                R"(Bearer realm="milepost", error="insufficient_scope")");
  return response;
}

bool is_within(const Grant& grant, Guard guard, std::string_view map) {
  switch (guard) {
    case Guard::open:
      return true;
    case Guard::catalog:
      return grant.is_valid();
    case Guard::map:
      return grant.is_for(map);
    case Guard::operators:
      return grant.is_for_everything();
  }
  return false;
}

}  // namespace

std::optional<Response> refusal(const Grant& grant, Guard guard, std::string_view map) {
  if (is_within(grant, guard, map)) return std::nullopt;
  return grant.is_valid() ? forbidden() : unauthorized(grant);
}

}  // namespace milepost::server
