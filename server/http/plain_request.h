// The fast path for ordinary requests.
#pragma once

#include <cstddef>
#include <string_view>

#include "server/http/request_parser.h"

namespace milepost::server {

// Takes a complete request that is GET or HEAD in HTTP/1.1, has no body and is written in the usual
// way; sets `incoming` and returns its length. Returns 0 for everything else, which RequestParser
// must decide on, and leaves `incoming` in any state. What it takes, RequestParser takes in the
// same way.
std::size_t take_plain_request(std::string_view bytes, const ConnectionLimits& limits,
                               Incoming& incoming);

}  // namespace milepost::server
