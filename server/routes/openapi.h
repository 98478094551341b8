// schema/openapi.yaml, embedded when the server was built.
#pragma once

#include <string_view>

namespace milepost::server {

std::string_view openapi_yaml();

}  // namespace milepost::server
