// A file of tokens, and an Authorization: "AUTHORIZATION\nFILE".
#include "server/access/tokens.h"

#include <cstdint>
#include <string>
#include <string_view>

#include "tests/fuzz/check.h"

using namespace milepost;
using namespace milepost::server;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view authorization = text.substr(0, end);
  const auto tokens = Tokens::parse(text.substr(std::min(end + 1, text.size())), "file");
  if (!tokens) {
    fuzz::check(!tokens.error().line().empty());
    return 0;
  }
  // What was read is written so that it is read in the same way.
  const std::string written = (*tokens)->text();
  const auto again = Tokens::parse(written, "again");
  fuzz::check(again.ok() && (*again)->text() == written);
  const auto now = *parse_utc("2026-12-01");
  const Grant grant = (*tokens)->grant(authorization, now);
  fuzz::check(grant.is_valid() == (grant.token() != nullptr));
  if (!grant.is_valid()) {
    fuzz::check(!grant.is_for_everything() && !grant.is_for("town"));
    fuzz::check(grant.is_of_bad_token() == !authorization.empty());
  }
  return 0;
}
