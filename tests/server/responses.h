// Accessors of responses for the tests of the routes.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "server/message/response.h"

namespace milepost::server {

inline constexpr const char* kImmutable = "public, max-age=31536000, immutable";

std::string text_of(const Response& response);

// The JSON document of a response, which must be one.
nlohmann::json json_of(const Response& response);

// The status, after a check of the problem document that must accompany it.
unsigned problem_status(const Response& response);

std::string detail_of(const Response& response);

}  // namespace milepost::server
