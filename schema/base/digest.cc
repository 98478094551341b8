#include "schema/base/digest.h"

#include <sodium.h>

#include <algorithm>
#include <bit>

namespace milepost {
namespace {

constexpr std::size_t kDigestBytes = 16;
static_assert(sizeof(crypto_generichash_state) <= 384);

crypto_generichash_state* as_state(std::array<unsigned char, 384>& bytes) {
  return reinterpret_cast<crypto_generichash_state*>(bytes.data());
}

std::string hexadecimal(const std::array<unsigned char, kDigestBytes>& digest) {
  std::array<char, 2 * kDigestBytes + 1> text{};
  sodium_bin2hex(text.data(), text.size(), digest.data(), digest.size());
  return text.data();
}

}  // namespace

std::string digest_of(ByteView bytes) {
  std::array<unsigned char, kDigestBytes> digest{};
  crypto_generichash(digest.data(), digest.size(), bytes.data(), bytes.size(), nullptr, 0);
  return hexadecimal(digest);
}

bool is_digest(std::string_view text) {
  return text.size() == 2 * kDigestBytes && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

FieldDigest::FieldDigest() { crypto_generichash_init(as_state(state_), nullptr, 0, kDigestBytes); }

void FieldDigest::add(ByteView field) {
  add(static_cast<std::uint64_t>(field.size()));
  crypto_generichash_update(as_state(state_), field.data(), field.size());
}

void FieldDigest::add(std::uint64_t number) {
  std::array<unsigned char, 8> little_endian{};
  for (auto& byte : little_endian) {
    byte = static_cast<unsigned char>(number & 0xffU);
    number >>= 8U;
  }
  crypto_generichash_update(as_state(state_), little_endian.data(), little_endian.size());
}

void FieldDigest::add(double number) { add(std::bit_cast<std::uint64_t>(number)); }

std::string FieldDigest::finish() {
  std::array<unsigned char, kDigestBytes> digest{};
  crypto_generichash_final(as_state(state_), digest.data(), digest.size());
  return hexadecimal(digest);
}

}  // namespace milepost
