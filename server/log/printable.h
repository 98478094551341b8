// Text of a client, for the log.
#pragma once

#include <string>
#include <string_view>

namespace milepost::server {

// The text with \xNN in place of each byte that is not printable ASCII, and with \\ and \" for
// these two: a client cannot forge lines of the log or control a terminal that shows it.
std::string printable(std::string_view text);

}  // namespace milepost::server
