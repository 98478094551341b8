// A client's request.
#pragma once

#include <string>

namespace milepost::server {

struct Request {
  std::string method;         // as received: "GET"
  std::string target;         // as received: path and query, percent-encoded
  std::string if_none_match;  // the field's value, empty if absent
};

}  // namespace milepost::server
