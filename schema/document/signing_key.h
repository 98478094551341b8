// The operator's keys: Ed25519 (RFC 8032), as one line of text in a file each (FORMAT.md 8).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost {

using SignatureBytes = std::array<std::uint8_t, 64>;

// Whoever has it can check signatures.
struct PublicKey {
  std::array<std::uint8_t, 32> bytes{};

  // The digest of the key: names it in signatures and messages.
  std::string id() const;
  // The content of the file KEY.pub.
  std::string text() const;
  bool has_signed(ByteView message, const SignatureBytes& signature) const;
};

// Whoever has it can sign. Its bytes are erased from memory when it is destroyed.
class SecretKey {
 public:
  using Seed = std::array<std::uint8_t, 32>;

  // A new random key. Errors: io (the system gives no random numbers).
  static Result<SecretKey> generate();

  explicit SecretKey(const Seed& seed);
  SecretKey(const SecretKey&) = default;
  SecretKey& operator=(const SecretKey&) = default;
  ~SecretKey();

  const PublicKey& public_key() const { return public_key_; }
  // The content of the file KEY.
  std::string text() const;
  SignatureBytes sign(ByteView message) const;

 private:
  Seed seed_;
  std::array<std::uint8_t, 64> expanded_{};  // as libsodium signs with it
  PublicKey public_key_;
};

// The key in the content of a file. Errors: invalid_input, with `where` empty.
Result<PublicKey> public_key_from(std::string_view text);
Result<SecretKey> secret_key_from(std::string_view text);

}  // namespace milepost
