// Pages of other origins that may read what the server sends (the Fetch standard's CORS protocol).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace milepost::server {

// Lines of a response's head for a request with this Origin, empty if absent, and method; empty if
// no origin is allowed. `allowed` holds origins as browsers send them, or "*" for all.
std::string cross_origin_lines(const std::vector<std::string>& allowed, std::string_view origin,
                               std::string_view method);

// Whether the text is an origin: "https://maps.example.org:8443", or "*".
bool is_origin(std::string_view text);

}  // namespace milepost::server
