// Compressed documents (RFC 9110, sections 8.4.1 and 12.5.3).
#pragma once

#include <string>
#include <string_view>

#include "schema/base/result.h"

namespace milepost::server {

enum class ContentCoding { identity, gzip, zstd };

// As in Accept-Encoding and Content-Encoding.
std::string_view name_of(ContentCoding coding);

// The best one for an Accept-Encoding field, empty if absent: the client's weights decide, then how
// small it is. A field that is not as RFC 9110 has it asks for identity.
ContentCoding preferred_coding(std::string_view accept_encoding);

// The same text always becomes the same bytes. Errors: io (memory is short).
Result<std::string> coded(std::string_view text, ContentCoding coding);

}  // namespace milepost::server
