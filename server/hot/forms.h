// The forms in which an answer may be sent: compressed, in part, or for one client's cache alone.
#pragma once

#include "server/hot/prepared.h"
#include "server/message/content_coding.h"
#include "server/message/request.h"

namespace milepost::server {

// Whether a response is a document that is worth compressing.
bool has_codings(const Response& response);

// A document in a coding. Its entity tag tells the coding, too. Errors: those of coded().
// REQUIRES: has_codings().
Result<PreparedAnswer> in_coding(const PreparedAnswer& answer, ContentCoding coding);

// The part of the answer that a GET asks for (206, or 416), or all of it, where it may be asked for
// in parts.
PreparedAnswer part_for(const PreparedAnswer& answer, const Request& request);

// With a Cache-Control by which no shared cache keeps it: others may not have it.
Response for_one_client(Response response);

}  // namespace milepost::server
