#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "schema/base/file.h"
#include "schema/base/output_file.h"
#include "schema/document/signature.h"
#include "server/catalog/map_file.h"
#include "server/catalog/signature_file.h"
#include "server/commands/commands.h"
#include "server/commands/whole_catalog.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSignDescription =
    R"(Signs maps, so that vehicles with the public key accept these and no others.

Writes a signature beside each map: town.map.sig of town.map. The map itself is not changed. The
signature binds the map's name, which is that of its file, its build and the time of signing. Sign
again after a map was built anew or renamed, and to go back to an older build: a vehicle refuses a
build that was signed before one that it has accepted of the same map.
The server sends signatures along, and needs no restart for them; the secret key need not be on its
host: copy the .sig files there with the maps.
Examples: milepost-server sign --maps /srv/milepost --key operator.key
          milepost-server sign --key operator.key new/town.map)";

struct SignOptions {
  std::string maps;
  std::vector<std::string> files;
  std::string key;
};

bool begins_signature(std::string_view head) { return head.starts_with("milepost-signature-"); }
const OutputKind kSignatureOutput = {"a milepost signature", begins_signature, false};

Result<SecretKey> read_key(const std::string& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  Result<SecretKey> key = secret_key_from(*text);
  if (key) return key;
  Error error = key.error();
  error.where = file;
  return error;
}

// Now, but later than the signature that is replaced, also if the clock was set back.
std::int64_t time_to_sign_s(const fs::path& replaced, const std::string& map) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const std::int64_t now_s = std::chrono::duration_cast<std::chrono::seconds>(now).count();
  const Result<std::string> text = read_text_file(replaced);
  const auto before = text ? signature_from(*text) : Result<Signature>(text.error());
  if (!before || before->about.map != map) return now_s;
  return std::max(now_s, before->about.signed_s + 1);
}

Status sign_map(const fs::path& file, const SecretKey& key) {
  const Status is_map = check_map_file(file);
  if (!is_map) return is_map.error();
  const Result<std::string> name = map_name_of(file);
  if (!name) return name.error();
  const Result<MapReader> reader = MapReader::open(file);
  if (!reader) return reader.error();
  const fs::path signature = signature_file_of(file);
  const Status free = check_outputs({{"the map's name", signature, &kSignatureOutput}}, {file});
  if (!free) return free;
  const SignedBuild about{*name, reader->build(), time_to_sign_s(signature, *name)};
  const Status written = write_text_file(signature, signature_text(about, key));
  if (written) std::cout << signature.string() << ": build " << about.build << " is signed\n";
  return written;
}

// The map files of a directory, as the server chooses them.
Result<std::vector<fs::path>> maps_in(const std::string& directory) {
  const auto catalog = open_whole_catalog(directory);
  if (!catalog) return catalog.error();
  std::vector<fs::path> files;
  for (const auto& [name, map] : (*catalog)->maps()) files.push_back(map->file);
  return files;
}

int sign(const std::string& program, const SignOptions& options) {
  const Result<SecretKey> key = read_key(options.key);
  if (!key) return fail(program, key.error());
  std::vector<fs::path> files(options.files.begin(), options.files.end());
  if (!options.maps.empty()) {
    Result<std::vector<fs::path>> found = maps_in(options.maps);
    if (!found) return fail(program, found.error());
    files = std::move(*found);
  }
  for (const fs::path& file : files) {
    const Status is_signed = sign_map(file, *key);
    if (!is_signed) return fail(program, is_signed.error());
  }
  return kExitDone;
}

}  // namespace

RunCommand add_sign(CLI::App& app) {
  app.description(kSignDescription);
  const auto options = std::make_shared<SignOptions>();
  CLI::Option* maps = app.add_option("--maps", options->maps, "Directory whose maps are all signed")
                          ->option_text("DIR");
  app.add_option("FILE", options->files, "Map files to sign")->excludes(maps)->option_text(" ");
  app.add_option("--key", options->key, "Secret key, which milepost-server keygen wrote")
      ->required()
      ->option_text("FILE");
  app.callback([options] {
    if (options->maps.empty() && options->files.empty()) {
      throw CLI::RequiredError("either --maps or files");
    }
  });
  return [options, program = name_of(app)] { return sign(program, *options); };
}

}  // namespace milepost::server
