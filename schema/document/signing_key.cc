#include "schema/document/signing_key.h"

#include <sodium.h>

#include "schema/base/digest.h"
#include "schema/document/hexadecimal.h"

namespace milepost {
namespace {

constexpr std::string_view kPublicKey = "milepost-public-key-1 ";
constexpr std::string_view kSecretKey = "milepost-secret-key-1 ";

std::string_view without_end(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

// The 32 bytes after `kind` in a line of text.
Result<std::array<std::uint8_t, 32>> key_bytes_in(std::string_view text, std::string_view kind,
                                                  const std::string& hint) {
  const std::string_view line = without_end(text);
  if (line.starts_with(kind)) {
    const auto bytes = bytes_in_hexadecimal<32>(line.substr(kind.size()));
    if (bytes) return *bytes;
  }
  return Error{ErrorCode::invalid_input, "",
               "it does not hold '" + std::string(kind) + "' and 64 hexadecimal digits", hint};
}

}  // namespace

std::string PublicKey::id() const { return digest_of(bytes); }

std::string PublicKey::text() const { return std::string(kPublicKey) + hexadecimal(bytes) + '\n'; }

bool PublicKey::has_signed(ByteView message, const SignatureBytes& signature) const {
  return crypto_sign_verify_detached(signature.data(), message.data(), message.size(),
                                     bytes.data()) == 0;
}

Result<SecretKey> SecretKey::generate() {
  if (sodium_init() < 0) {
    return Error{ErrorCode::io, "a new key", "the system gives no random numbers",
                 "check /dev/urandom"};
  }
  Seed seed{};
  randombytes_buf(seed.data(), seed.size());
  SecretKey key(seed);
  sodium_memzero(seed.data(), seed.size());
  return key;
}

SecretKey::SecretKey(const Seed& seed) : seed_(seed) {
  crypto_sign_seed_keypair(public_key_.bytes.data(), expanded_.data(), seed_.data());
}

SecretKey::~SecretKey() {
  sodium_memzero(seed_.data(), seed_.size());
  sodium_memzero(expanded_.data(), expanded_.size());
}

std::string SecretKey::text() const { return std::string(kSecretKey) + hexadecimal(seed_) + '\n'; }

SignatureBytes SecretKey::sign(ByteView message) const {
  SignatureBytes signature{};
  crypto_sign_detached(signature.data(), nullptr, message.data(), message.size(), expanded_.data());
  return signature;
}

Result<PublicKey> public_key_from(std::string_view text) {
  const auto bytes =
      key_bytes_in(text, kPublicKey, "give the file KEY.pub that milepost-server keygen wrote");
  if (!bytes) return bytes.error();
  return PublicKey{*bytes};
}

Result<SecretKey> secret_key_from(std::string_view text) {
  const auto seed =
      key_bytes_in(text, kSecretKey, "give the file KEY that milepost-server keygen wrote");
  if (!seed) return seed.error();
  return SecretKey(*seed);
}

}  // namespace milepost
