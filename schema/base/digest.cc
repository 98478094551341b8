#include "schema/base/digest.h"

#include <sodium.h>

#include <algorithm>
#include <array>

namespace milepost {
namespace {

constexpr std::size_t kDigestBytes = 16;

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

}  // namespace milepost
