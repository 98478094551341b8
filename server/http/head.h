// The status line and the header of a response, as bytes.
#pragma once

#include <string>

#include "server/message/response.h"

namespace milepost::server {

// `http_version` is 10 or 11.
std::string head_of(const Response& response, unsigned http_version, bool keep_alive);

// The current time in HTTP's format (RFC 9110, section 5.6.7).
std::string http_date();

}  // namespace milepost::server
