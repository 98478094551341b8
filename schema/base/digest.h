// BLAKE2b digests of 16 bytes, written as 32 lower-case hexadecimal digits.
// They identify tiles, documents and builds, to detect damage and to distinguish versions; they do
// not authenticate.
#pragma once

#include <string>
#include <string_view>

#include "schema/base/bytes.h"

namespace milepost {

std::string digest_of(ByteView bytes);

// Whether `text` has the form of a digest.
bool is_digest(std::string_view text);

}  // namespace milepost
