// The requests in the bytes of a connection, one after the other.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/http/request_parser.h"

namespace milepost::server {

// Holds no memory while no byte is waiting. Not safe to use from several threads at once.
class RequestReader {
 public:
  // `limits` must outlive the reader.
  explicit RequestReader(const ConnectionLimits& limits) : limits_(limits) {}

  // Bytes that have arrived. They are not copied: they must stay valid until keep().
  void add(std::string_view bytes);
  // Takes the next request, if it is complete. `incoming` keeps its memory from call to call.
  bool next(Incoming& incoming);
  // Copies the bytes that are left.
  void keep();

  // No byte of a further request has arrived.
  bool empty() const { return bytes_.empty() && parser_ == nullptr; }
  // The client waits for 100 Continue before it sends the body; true once for each request.
  bool wants_continue();

 private:
  const ConnectionLimits& limits_;
  std::string_view bytes_;  // not yet taken
  std::string kept_;
  bool is_kept_ = false;                   // bytes_ are in kept_
  std::unique_ptr<RequestParser> parser_;  // of a request that is not plain, or not complete
  bool continued_ = false;                 // 100 Continue was asked for
};

}  // namespace milepost::server
