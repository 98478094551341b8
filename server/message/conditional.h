// Entity tags and conditional requests (RFC 9110, sections 8.8.3 and 13.1.2).
#pragma once

#include <string>
#include <string_view>

#include "server/message/response.h"

namespace milepost::server {

// The strong entity tag of a digest, with its quotes.
std::string entity_tag(const std::string& digest);

// Whether an If-None-Match field, empty if absent, names `tag`.
bool names_tag(std::string_view if_none_match, std::string_view tag);

// The response itself, or 304 if the client already has it.
Response unless_known(Response response, std::string_view if_none_match);

}  // namespace milepost::server
