#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "schema/base/file.h"
#include "schema/base/ids.h"
#include "schema/base/output_file.h"
#include "server/access/tokens.h"
#include "server/commands/commands.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

constexpr const char* kTokenDescription =
    R"(Makes tokens, takes them back and lists them: milepost-server --tokens FILE answers nothing of a
map without one.

A new token is printed once, on standard output, and kept nowhere: FILE, which the server's user must
be able to read, holds its SHA-256, whose it is, for which maps and until when. Whoever has the token has what it allows: send it to vehicles on
a safe way, and serve over TLS (--tls-cert). A running server reads FILE again within 30 s, or at
once on SIGHUP.
Examples: milepost-server token --tokens tokens.json --add fleet-7 --map town --map village
          milepost-server token --tokens tokens.json --add operator --all-maps --days 365
          milepost-server token --tokens tokens.json --remove fleet-7
          milepost-server token --tokens tokens.json --list
          milepost-client localize --server https://maps.example.org --token-file fleet-7.token ...)";

constexpr int kMaxDays = 36'500;

struct TokenOptions {
  std::string file;
  std::string add;
  std::vector<std::string> maps;
  bool all_maps = false;
  std::string expires;
  int days = 0;
  std::string remove;
  bool list = false;
};

bool begins_tokens(std::string_view head) { return begins_without_space(head, "{\"tokens\""); }
const OutputKind kTokensOutput = {"a file of tokens", begins_tokens, false};

// The tokens of the file; none if it does not exist.
Result<Tokens> read_tokens(const fs::path& file) {
  const auto tokens = Tokens::read(file);
  if (tokens) return **tokens;
  if (tokens.error().code == ErrorCode::not_found) return Tokens();
  return tokens.error();
}

Error wrong_call(const std::string& where, const std::string& what, const std::string& hint) {
  return {ErrorCode::invalid_input, where, what, hint};
}

// What the new token is for.
Result<TokenEntry> entry_for(const TokenOptions& options) {
  TokenEntry entry;
  entry.name = options.add;
  entry.all_maps = options.all_maps;
  entry.maps = {options.maps.begin(), options.maps.end()};
  if (!is_token_name(entry.name)) {
    return wrong_call("--add " + entry.name, "is no name",
                      "write 1 to 64 of A-Z a-z 0-9 . _ - @, not starting with a dot");
  }
  if (entry.all_maps != entry.maps.empty()) {
    return wrong_call("--add " + entry.name, "is for no map, or for all and some",
                      "give --map for each, or --all-maps");
  }
  for (const std::string& map : entry.maps) {
    if (!is_segment_id(map)) {
      return wrong_call("--map " + map, "is no map's name", "/v1/maps lists the maps");
    }
  }
  if (options.days > 0) {
    entry.expires = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()) +
                    std::chrono::days(options.days);
  }
  if (options.expires.empty()) return entry;
  const auto expires = parse_utc(options.expires);
  if (!expires) return expires.error();
  entry.expires = *expires;
  return entry;
}

// Whole at every instant. Who may read it stays as it is.
Status write_tokens(const fs::path& file, const Tokens& tokens) {
  std::error_code absent;
  const fs::file_status before = fs::status(file, absent);
  Status written = write_text_file(file, tokens.text());
  std::error_code ignored;  // it holds no secret
  if (written && fs::is_regular_file(before)) fs::permissions(file, before.permissions(), ignored);
  return written;
}

Status add_token(const TokenOptions& options, Tokens tokens) {
  Result<TokenEntry> entry = entry_for(options);
  if (!entry) return entry.error();
  if (tokens.named(entry->name) != nullptr) {
    return wrong_call(options.file, "has a token '" + entry->name + "' already",
                      "give another name, or --remove it first");
  }
  Result<Tokens::NewToken> made = Tokens::generate(std::move(*entry));
  if (!made) return made.error();
  tokens.add(std::move(made->entry));
  const Status written = write_tokens(options.file, tokens);
  if (written) std::cout << made->token << std::endl;
  return written;
}

Status remove_token(const TokenOptions& options, Tokens tokens) {
  const TokenEntry* entry = tokens.named(options.remove);
  if (entry == nullptr) {
    return wrong_call(options.file, "has no token '" + options.remove + "'",
                      "--list shows the tokens");
  }
  tokens.remove(std::string(entry->id));
  return write_tokens(options.file, tokens);
}

void list_tokens(const Tokens& tokens) {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  for (const auto& [id, entry] : tokens.entries()) {
    std::cout << entry->name << "  " << id << "  ";
    if (entry->expires == std::chrono::sys_seconds()) {
      std::cout << "never expires";
    } else {
      std::cout << (entry->expires <= now ? "expired " : "expires ") << utc_text(entry->expires);
    }
    std::cout << "  maps:";
    if (entry->all_maps) std::cout << " all";
    for (const std::string& map : entry->maps) std::cout << ' ' << map;
    std::cout << '\n';
  }
  std::cout << std::flush;
}

Status change_tokens(const TokenOptions& options) {
  const Status writable =
      options.list ? ok_status() : check_outputs({{"--tokens", options.file, &kTokensOutput}}, {});
  if (!writable) return writable;
  Result<Tokens> tokens = read_tokens(options.file);
  if (!tokens) return tokens.error();
  if (!options.add.empty()) return add_token(options, std::move(*tokens));
  if (!options.remove.empty()) return remove_token(options, std::move(*tokens));
  list_tokens(*tokens);
  return ok_status();
}

}  // namespace

RunCommand add_token_command(CLI::App& app) {
  app.description(kTokenDescription);
  const auto options = std::make_shared<TokenOptions>();
  app.add_option("--tokens", options->file, "File of the tokens; made if it does not exist")
      ->required()
      ->option_text("FILE");
  auto* what = app.add_option_group("What to do", "");
  what->add_option("--add", options->add, "Make a token with this name")->option_text("NAME");
  what->add_option("--remove", options->remove, "Take the token with this name back")
      ->option_text("NAME");
  what->add_flag("--list", options->list, "List the tokens");
  what->require_option(1);
  app.add_option("--map", options->maps, "Map that it is for; several may be given")
      ->option_text("MAP...");
  app.add_flag("--all-maps", options->all_maps, "It is for all maps, /metrics and the page at /");
  auto* expires =
      app.add_option("--expires", options->expires,
                     "When it ends, in UTC: 2027-01-01 or 2027-01-01T12:00:00Z (default never)")
          ->option_text("TIME");
  app.add_option("--days", options->days, "The same, in days from now")
      ->check(CLI::Range(1, kMaxDays))
      ->excludes(expires)
      ->option_text("N");
  return [options, program = name_of(app)] {
    const Status done = change_tokens(*options);
    return done ? kExitDone : fail(program, done.error());
  };
}

}  // namespace milepost::server
