// What a client asked for, as values.
#pragma once

#include <string>

namespace milepost::server {

struct Request {
  std::string method;         // as it came: "GET"
  std::string target;         // as it came: path and query, percent-encoded
  std::string if_none_match;  // the field's value, empty if absent
};

}  // namespace milepost::server
