// The status line and the header of a response, as bytes.
#pragma once

#include <ctime>
#include <string>
#include <string_view>

#include "server/message/response.h"

namespace milepost::server {

// All of the head that depends on nothing but the response: what follows is one of HeadEnds.
std::string head_of(const Response& response);

// The last lines of a head: the date, whether the connection stays open, the empty line. Not safe
// to use from several threads at once.
class HeadEnds {
 public:
  // Valid until the next call. `http_version` is 10 or 11, `now` the current time.
  std::string_view end(std::time_t now, unsigned http_version, bool keep_alive);

 private:
  std::time_t at_ = -1;
  std::string open_;      // HTTP/1.1: without a line for it
  std::string open_1_0_;  // HTTP/1.0
  std::string closed_;
};

// A time in HTTP's format (RFC 9110, section 5.6.7).
std::string http_date(std::time_t time);

}  // namespace milepost::server
