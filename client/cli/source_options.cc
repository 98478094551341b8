#include "client/cli/source_options.h"

#include <algorithm>

#include "client/fetch/file_source.h"
#include "client/fetch/http_source.h"
#include "schema/base/file.h"
#include "schema/command/command.h"
#include "schema/document/signing_key.h"

namespace milepost {

void add_source_options(CLI::App& app, SourceOptions& options) {
  CLI::Option_group* group =
      app.add_option_group("Map", "Where the map comes from: a server, or a file");
  CLI::Option* server =
      group
          ->add_option("--server", options.server, "Tile server to fetch from, http(s)://HOST:PORT")
          ->option_text("URL");
  CLI::Option* cache =
      group->add_option("--cache", options.cache, "Folder to cache fetched tiles in")
          ->option_text("DIR");
  CLI::Option* limit =
      add_number(*group, "--cache-limit-mb", options.cache_limit_mb, "MB",
                 "Maximum cache size in megabytes; least recently used tiles are evicted", 1, 1e6);
  CLI::Option* keys =
      group
          ->add_option("--key", options.keys,
                       "Use only maps that are signed with this public key; several --key FILE\n"
                       "accept any of them")
          ->option_text("FILE.pub")
          ->allow_extra_args(false);
  CLI::Option* token = group
                           ->add_option("--token-file", options.token_file,
                                        "Token that the server asks for, as its operator made it")
                           ->option_text("FILE");
  CLI::Option* ca = group
                        ->add_option("--ca-file", options.ca_file,
                                     "Certificates by which the server is trusted over https\n"
                                     "(default: those of the system)")
                        ->option_text("FILE.pem");
  CLI::Option* map = group->add_option("--map", options.map, "Map file to read instead of a server")
                         ->option_text("FILE");
  server->needs(cache)->excludes(map);
  cache->needs(server);
  limit->needs(server);
  keys->needs(server);
  token->needs(server);
  ca->needs(server);
}

void require_source(const SourceOptions& options) {
  if (options.server.empty() && options.map.empty()) {
    throw CLI::RequiredError("either --server or --map");
  }
}

void add_receiver_option(CLI::App& app, std::optional<double>& until_s) {
  app.add_option("--receiver-until-s", until_s,
                 "Ignore rows of gps.csv later than this after the first frame")
      ->check([](const std::string& word) {
        return word.starts_with('-') ? "'" + word + "' is below 0; give seconds" : std::string();
      })
      ->option_text("S");
}

namespace {

Result<std::vector<PublicKey>> read_keys(const std::vector<std::string>& files) {
  std::vector<PublicKey> keys;
  for (const std::string& file : files) {
    const Result<std::string> text = read_text_file(file);
    if (!text) return text.error();
    const Result<PublicKey> key = public_key_from(*text);
    if (!key) {
      Error error = key.error();
      error.where = file;
      return error;
    }
    keys.push_back(*key);
  }
  return keys;
}

// The one word of the file; empty without a file.
Result<std::string> read_token(const std::string& file) {
  if (file.empty()) return std::string();
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  constexpr const char* kSpace = " \t\r\n";
  const std::size_t begin = std::min(text->find_first_not_of(kSpace), text->size());
  const std::string token = text->substr(begin, text->find_last_not_of(kSpace) + 1 - begin);
  const bool is_word =
      !token.empty() && std::ranges::all_of(token, [](char c) { return c > 0x20 && c < 0x7f; });
  if (is_word) return token;
  return Error{ErrorCode::invalid_input, file, "holds no token, which is one word",
               "give the file that has what 'milepost-server token --add' printed"};
}

Status check_readable(const std::string& file) {
  if (file.empty()) return ok_status();
  const Result<std::string> text = read_text_file(file);
  return text ? ok_status() : Status(text.error());
}

}  // namespace

std::vector<std::filesystem::path> inputs_of(const Drive& drive, const SourceOptions& options) {
  std::vector<std::filesystem::path> inputs = files_of(drive);
  if (!options.map.empty()) inputs.emplace_back(options.map);
  return inputs;
}

Result<std::shared_ptr<MapSource>> open_source(const SourceOptions& options) {
  if (!options.map.empty()) return open_file_source(options.map);
  Result<std::vector<PublicKey>> keys = read_keys(options.keys);
  if (!keys) return keys.error();
  Result<std::string> token = read_token(options.token_file);
  if (!token) return token.error();
  const Status has_certificates = check_readable(options.ca_file);
  if (!has_certificates) return has_certificates.error();
  HttpSourceSettings settings;
  settings.server_url = options.server;
  settings.cache_directory = options.cache;
  settings.cache_limit_bytes = static_cast<std::uint64_t>(options.cache_limit_mb * 1e6);
  settings.stopped = stop_requested;
  settings.keys = std::move(*keys);
  settings.token = std::move(*token);
  settings.ca_file = options.ca_file;
  return open_http_source(settings);
}

}  // namespace milepost
