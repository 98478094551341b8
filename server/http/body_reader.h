// The body of a response, piece by piece: memory holds one tile or cell at a time.
#pragma once

#include <cstddef>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "server/message/response.h"

namespace milepost::server {

class BodyReader {
 public:
  // Reads nothing if the client does not want a body. `response` must outlive the reader.
  BodyReader(const Response& response, bool wanted);

  bool done() const { return given_ == pieces_; }
  // The next piece: the whole text, or one tile or cell; empty when done. Valid until the next
  // call. Errors: those of ServedMap::tile and cell.
  Result<ByteView> next();

 private:
  const Response* response_;
  std::size_t pieces_ = 0;
  std::size_t given_ = 0;
  Bytes frame_;
};

}  // namespace milepost::server
