#include "schema/document/signature.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "schema/base/digest.h"
#include "schema/base/ids.h"
#include "schema/document/hexadecimal.h"

namespace milepost {
namespace {

constexpr std::string_view kFirstLine = "milepost-signature-1\n";
constexpr std::size_t kMaxTimeDigits = 12;

// The bytes that are signed: all lines before the signature itself.
std::string statement_of(const SignedBuild& about, const std::string& key) {
  return std::string(kFirstLine) + "map " + about.map + "\nbuild " + about.build + "\nsigned_s " +
         std::to_string(about.signed_s) + "\nkey " + key + '\n';
}

// Takes lines "NAME VALUE" off a text.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  std::optional<std::string_view> value_of(std::string_view name) {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (!line.starts_with(name) || line.substr(name.size(), 1) != " ") return std::nullopt;
    return line.substr(name.size() + 1);
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

std::optional<std::int64_t> time_in(std::string_view text) {
  const bool is_digits = std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  const bool is_plain = text.size() == 1 || (!text.empty() && text.front() != '0');
  if (!is_digits || !is_plain || text.size() > kMaxTimeDigits) return std::nullopt;
  std::int64_t seconds = 0;
  std::from_chars(text.data(), text.data() + text.size(), seconds);
  return seconds;
}

Error no_signature(const std::string& what) {
  return {ErrorCode::corrupt, "", "the signature " + what, "sign the map again"};
}

}  // namespace

bool Signature::is_by(const PublicKey& public_key) const {
  return key == public_key.id() && public_key.has_signed(as_bytes(statement_of(about, key)), bytes);
}

std::string signature_text(const SignedBuild& about, const SecretKey& key) {
  const std::string statement = statement_of(about, key.public_key().id());
  return statement + "ed25519 " + hexadecimal(key.sign(as_bytes(statement))) + '\n';
}

Result<Signature> signature_from(std::string_view text) {
  if (!text.starts_with(kFirstLine)) return no_signature("does not begin as one of milepost");
  Lines lines(text.substr(kFirstLine.size()));
  const auto map = lines.value_of("map");
  if (!map || !is_segment_id(*map)) return no_signature("names no map");
  const auto build = lines.value_of("build");
  if (!build || !is_digest(*build)) return no_signature("names no build");
  const auto time = lines.value_of("signed_s");
  const auto signed_s = time ? time_in(*time) : std::nullopt;
  if (!signed_s) return no_signature("has no time");
  const auto key = lines.value_of("key");
  if (!key || !is_digest(*key)) return no_signature("names no key");
  const auto digits = lines.value_of("ed25519");
  const auto bytes = digits ? bytes_in_hexadecimal<64>(*digits) : std::nullopt;
  if (!bytes || !lines.at_end()) return no_signature("is truncated, or something follows it");
  return Signature{{std::string(*map), std::string(*build), *signed_s}, std::string(*key), *bytes};
}

}  // namespace milepost
