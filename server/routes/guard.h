// Whose requests a route answers, where tokens are asked for.
#pragma once

#include <optional>
#include <string_view>

#include "server/access/grant.h"
#include "server/message/response.h"

namespace milepost::server {

// 401 or 403 if the grant is not for a route with this guard; `map` is the one that its path names.
// What is refused is refused whether it exists or not.
std::optional<Response> refusal(const Grant& grant, Guard guard, std::string_view map);

}  // namespace milepost::server
