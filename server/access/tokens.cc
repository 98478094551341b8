#include "server/access/tokens.h"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "schema/base/bytes.h"
#include "schema/base/file.h"
#include "schema/base/ids.h"
#include "schema/base/json.h"
#include "schema/document/hexadecimal.h"
#include "server/message/letters.h"

namespace milepost::server {
namespace {

using Time = std::chrono::sys_seconds;
using Json = nlohmann::json;

constexpr std::string_view kPrefix = "mp_";
constexpr std::size_t kIdBytes = 8;
constexpr std::size_t kSecretBytes = 32;
constexpr std::size_t kTokenCharacters = 3 + 2 * kIdBytes + 1 + 2 * kSecretBytes;
constexpr std::string_view kScheme = "bearer ";
constexpr JsonLimits kLimits = {16U << 20U, 1'000'000, 8, 64};

std::string sha256_of(std::string_view text) {
  std::array<std::uint8_t, crypto_hash_sha256_BYTES> hash{};
  const ByteView bytes = as_bytes(text);
  crypto_hash_sha256(hash.data(), bytes.data(), bytes.size());
  return hexadecimal(hash);
}

// The id in a token; empty if the text is no token.
std::string_view id_in(std::string_view token) {
  if (token.size() != kTokenCharacters || !token.starts_with(kPrefix)) return {};
  return token.substr(kPrefix.size(), 2 * kIdBytes);
}

// The token in the value of Authorization; empty if there is none.
std::string_view token_in(std::string_view authorization) {
  if (!equals_lower(authorization.substr(0, kScheme.size()), kScheme)) return {};
  authorization.remove_prefix(kScheme.size());
  authorization.remove_prefix(std::min(authorization.find_first_not_of(' '), authorization.size()));
  return authorization;
}

Error no_tokens(const std::string& where, const std::string& what) {
  return {ErrorCode::corrupt, where, what, "write tokens with 'milepost-server token'"};
}

// Reads the members of one entry, and tells which are not of one.
class EntryReader {
 public:
  EntryReader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}

  Result<TokenEntry> read() const {
    if (!json_.is_object()) return fault("is no object");
    for (const auto& member : json_.items()) {
      if (std::ranges::find(kKeys, member.key()) == kKeys.end()) {
        return fault("has an unknown key '" + member.key() + "'");
      }
    }
    TokenEntry entry;
    entry.id = text("id");
    entry.name = text("name");
    entry.sha256 = text("sha256");
    if (!bytes_in_hexadecimal<kIdBytes>(entry.id)) return fault("has no id of 16 digits");
    if (!is_token_name(entry.name)) return fault("has no name of A-Z a-z 0-9 . _ - @");
    if (!bytes_in_hexadecimal<32>(entry.sha256)) return fault("has no sha256 of 64 digits");
    const Status maps = read_maps(entry);
    if (!maps) return maps.error();
    if (!json_.contains("expires")) return entry;
    const auto expires = parse_utc(text("expires"));
    if (!expires) return fault("has an 'expires' that is no time");
    entry.expires = *expires;
    return entry;
  }

 private:
  static constexpr std::array<std::string_view, 5> kKeys = {"id", "name", "sha256", "maps",
                                                            "expires"};

  Error fault(const std::string& what) const { return no_tokens(where_, what); }
  // Empty if it is not there, or no text.
  std::string text(const char* key) const {
    const auto member = json_.find(key);
    return member == json_.end() || !member->is_string() ? "" : member->get<std::string>();
  }
  Status read_maps(TokenEntry& entry) const {
    const auto maps = json_.find("maps");
    entry.all_maps = maps != json_.end() && *maps == "*";
    if (entry.all_maps) return ok_status();
    if (maps == json_.end() || !maps->is_array()) return fault("has no 'maps', a list or \"*\"");
    for (const Json& map : *maps) {
      if (!map.is_string() || !is_segment_id(map.get<std::string>())) {
        return fault("lists a map whose name cannot be one");
      }
      entry.maps.insert(map.get<std::string>());
    }
    return ok_status();
  }

  const Json& json_;
  const std::string where_;
};

}  // namespace

Result<std::shared_ptr<const Tokens>> Tokens::parse(std::string_view text,
                                                    const std::string& where) {
  const Result<Json> json = read_json(text, kLimits);
  if (!json) {
    return no_tokens(json.error().where.empty() ? where : where + ", " + json.error().where,
                     json.error().what);
  }
  const bool is_list = json->is_object() && json->size() == 1 && json->contains("tokens") &&
                       json->at("tokens").is_array();
  if (!is_list) return no_tokens(where, "is not a list of tokens");
  auto tokens = std::make_shared<Tokens>();
  for (const Json& one : json->at("tokens")) {
    const std::string place = where + ", token " + std::to_string(tokens->entries_.size() + 1);
    Result<TokenEntry> entry = EntryReader(one, place).read();
    if (!entry) return entry.error();
    if (tokens->entries_.contains(entry->id) || tokens->named(entry->name) != nullptr) {
      return no_tokens(place, "has the id or the name of another one");
    }
    tokens->add(std::move(*entry));
  }
  return std::shared_ptr<const Tokens>(std::move(tokens));
}

Result<std::shared_ptr<const Tokens>> Tokens::read(const std::filesystem::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  return parse(*text, file.string());
}

std::string Tokens::text() const {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [id, entry] : entries_) {
    nlohmann::ordered_json one = {{"id", id}, {"name", entry->name}, {"sha256", entry->sha256}};
    if (entry->all_maps) {
      one["maps"] = "*";
    } else {
      one["maps"] = entry->maps;
    }
    if (entry->expires != Time()) one["expires"] = utc_text(entry->expires);
    list.push_back(std::move(one));
  }
  const nlohmann::ordered_json json = {{"tokens", std::move(list)}};
  return json.dump(1) + "\n";
}

Grant Tokens::grant(std::string_view authorization, Time now) const {
  if (authorization.empty()) return Grant::without_token();
  const std::string_view token = token_in(authorization);
  const auto found = entries_.find(id_in(token));
  if (found == entries_.end()) return Grant::of_unknown_token();
  const std::string hash = sha256_of(token);
  const std::string& expected = found->second->sha256;
  if (sodium_memcmp(hash.data(), expected.data(), expected.size()) != 0) {
    return Grant::of_unknown_token();
  }
  const Time expires = found->second->expires;
  if (expires != Time() && expires <= now) return Grant::of_expired_token();
  return Grant::by(found->second);
}

Result<Tokens::NewToken> Tokens::generate(TokenEntry about) {
  if (sodium_init() < 0) {
    return Error{ErrorCode::io, "a new token", "the system gives no random numbers",
                 "check /dev/urandom"};
  }
  std::array<std::uint8_t, kIdBytes> id{};
  std::array<std::uint8_t, kSecretBytes> secret{};
  randombytes_buf(id.data(), id.size());
  randombytes_buf(secret.data(), secret.size());
  about.id = hexadecimal(id);
  std::string token = std::string(kPrefix) + about.id + "_" + hexadecimal(secret);
  about.sha256 = sha256_of(token);
  return NewToken{std::move(token), std::move(about)};
}

const TokenEntry* Tokens::named(std::string_view name) const {
  const auto found = std::ranges::find_if(
      entries_, [name](const auto& entry) { return entry.second->name == name; });
  return found == entries_.end() ? nullptr : found->second.get();
}

void Tokens::add(TokenEntry entry) {
  std::string id = entry.id;
  entries_.emplace(std::move(id), std::make_shared<const TokenEntry>(std::move(entry)));
}

bool is_token_name(std::string_view text) {
  std::string without_at(text);
  std::ranges::replace(without_at, '@', '-');
  return is_segment_id(without_at);
}

Result<Time> parse_utc(const std::string& text) {
  std::tm utc{};
  const std::string whole = text.size() == 10 ? text + "T00:00:00Z" : text;
  const char* end = ::strptime(whole.c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  const Time time{std::chrono::seconds(timegm(&utc))};
  // Only a time in exactly this form is written as it was read.
  if (end != nullptr && *end == '\0' && time > Time() && utc_text(time) == whole) return time;
  return Error{ErrorCode::invalid_input, "time " + text, "is not a time in UTC",
               "write it as 2027-01-01 or 2027-01-01T00:00:00Z"};
}

std::string utc_text(Time time) {
  const std::time_t seconds = time.time_since_epoch().count();
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

}  // namespace milepost::server
