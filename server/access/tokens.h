// The bearer tokens (RFC 6750) that the server accepts.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "schema/base/result.h"
#include "server/access/grant.h"
#include "server/current/current.h"

namespace milepost::server {

// A token is "mp_", 16 hexadecimal digits, its id, "_" and 64 more, its secret: 256 random bits.
// The file has the SHA-256 of it, so that who reads the file has no token. It is a JSON document:
//   {"tokens": [{"id": "5d1f…", "name": "fleet-7", "sha256": "9f86…", "maps": ["town"],
//                "expires": "2027-01-01T00:00:00Z"}]}
// "maps" is a list of names or "*", all of them; "expires" may be absent.
class Tokens {
 public:
  // Errors of both: corrupt (no such document, an unknown key, an id or name twice), and of read
  // those of read_text_file.
  static Result<std::shared_ptr<const Tokens>> parse(std::string_view text,
                                                     const std::string& where);
  static Result<std::shared_ptr<const Tokens>> read(const std::filesystem::path& file);
  std::string text() const;

  // What the value of a request's Authorization, empty if absent, allows. The secret is compared in
  // constant time.
  Grant grant(std::string_view authorization, std::chrono::sys_seconds now) const;

  struct NewToken {
    std::string token;  // to be given away; nobody can find it out again
    TokenEntry entry;
  };
  // With a new id, secret and hash. Errors: io (no random numbers).
  static Result<NewToken> generate(TokenEntry about);

  // By id.
  const std::map<std::string, std::shared_ptr<const TokenEntry>, std::less<>>& entries() const {
    return entries_;
  }
  const TokenEntry* named(std::string_view name) const;  // null if there is none
  // REQUIRES: neither its id nor its name is there.
  void add(TokenEntry entry);
  void remove(const std::string& id) { entries_.erase(id); }

 private:
  std::map<std::string, std::shared_ptr<const TokenEntry>, std::less<>> entries_;
};

using CurrentTokens = Current<Tokens>;

// Whether the text can be a token's name: 1 to 64 of A-Z a-z 0-9 . _ - @.
bool is_token_name(std::string_view text);

// A time in UTC as "2027-01-01T00:00:00Z", or a day as "2027-01-01", its start. Errors:
// invalid_input.
Result<std::chrono::sys_seconds> parse_utc(const std::string& text);
std::string utc_text(std::chrono::sys_seconds time);

}  // namespace milepost::server
