// BLAKE2b digests of 16 bytes, written as 32 lower-case hexadecimal digits.
// They identify tiles and builds, to detect damage and to distinguish versions; they do not
// authenticate.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "schema/base/bytes.h"

namespace milepost {

std::string digest_of(ByteView bytes);

// Whether `text` has the form of a digest.
bool is_digest(std::string_view text);

// Digests a sequence of fields. Each field is preceded by its length, so that different sequences
// of fields never hash the same bytes.
class FieldDigest {
 public:
  FieldDigest();
  void add(ByteView field);
  void add(std::string_view field) { add(as_bytes(field)); }
  void add(std::uint64_t number);  // as 8 bytes, little endian
  void add(double number);         // as its IEEE 754 bits, 8 bytes, little endian
  std::string finish();            // call once

 private:
  alignas(64) std::array<unsigned char, 384> state_;
};

}  // namespace milepost
