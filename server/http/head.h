// The status line and the header of an answer, as bytes.
#pragma once

#include <string>

#include "server/message/response.h"

namespace milepost::server {

// `http_version` is 10 or 11.
std::string head_of(const Response& response, unsigned http_version, bool keep_alive);

// The current time as HTTP writes it (RFC 9110, section 5.6.7).
std::string http_date();

}  // namespace milepost::server
