// The detached signature of a build: who vouches for it, under which name (FORMAT.md 8).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "schema/base/result.h"
#include "schema/document/signing_key.h"

namespace milepost {

inline constexpr std::uint64_t kMaxSignatureBytes = 512;  // of the text

// What is signed. The build is the digest of the manifest, so it stands for every byte of the map.
struct SignedBuild {
  std::string map;  // the name under which the build is served
  std::string build;
  std::int64_t signed_s = 0;  // when, in seconds since 1970 UTC; 0 to 999999999999
};

struct Signature {
  SignedBuild about;
  std::string key;  // PublicKey::id of the key that is said to have signed
  SignatureBytes bytes{};

  // Whether that key has signed exactly this.
  bool is_by(const PublicKey& public_key) const;
};

// The text of a signature, as stored beside the map and served. REQUIRES: a map name and a build
// that are usable in a URL, and a time in range.
std::string signature_text(const SignedBuild& about, const SecretKey& key);

// Reads the one form that signature_text() writes. It says nothing about who signed. Errors:
// corrupt, with `where` empty.
Result<Signature> signature_from(std::string_view text);

}  // namespace milepost
