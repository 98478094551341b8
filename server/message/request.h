// A client's request.
#pragma once

#include <string>

namespace milepost::server {

struct Request {
  std::string method;  // as received: "GET"
  std::string target;  // as received: path and query, percent-encoded
  // The values of fields, empty if absent:
  std::string if_none_match = {};
  std::string if_range = {};
  std::string range = {};
  std::string accept_encoding = {};
  std::string authorization = {};
  std::string origin = {};

  friend bool operator==(const Request&, const Request&) = default;
};

}  // namespace milepost::server
