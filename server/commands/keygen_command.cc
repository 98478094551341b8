#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>

#include "schema/document/signing_key.h"
#include "server/commands/commands.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

constexpr const char* kKeygenDescription =
    R"(Makes a key to sign maps with.

Writes two files: FILE, the secret key, readable by you alone, and FILE.pub, the public key, which
vehicles get. Whoever has the secret key can sign maps that they accept: keep it off the host of the
server. An existing file is not replaced.
Example: milepost-server keygen --out operator.key
         milepost-server sign --maps maps --key operator.key
         milepost-client localize --key operator.key.pub ...)";

constexpr mode_t kOwnerOnly = 0600;
constexpr mode_t kEveryoneReads = 0644;

std::string reason_of(int error) { return std::generic_category().message(error); }

// Writes all of `text` to the disk. False with errno set if that fails.
bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(descriptor) == 0;
}

// A new file with these permissions from its first byte on.
Status create_file(const fs::path& file, const std::string& text, mode_t permissions) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, permissions);
  if (descriptor < 0 && errno == EEXIST) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "the file exists, and a key is not replaced",
                 "give another file with --out, or remove this one first"};
  }
  bool is_written = descriptor >= 0 && write_all(descriptor, text);
  const int failure = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (is_written) return ok_status();
  if (descriptor >= 0) ::unlink(file.c_str());
  return Error{ErrorCode::io, file.string(), "cannot be written (" + reason_of(failure) + ")",
               "check the folder, its permissions and the disk's space"};
}

int keygen(const std::string& program, const std::string& out) {
  const Result<SecretKey> key = SecretKey::generate();
  if (!key) return fail(program, key.error());
  const fs::path public_file = out + ".pub";
  // The public one first: a secret key without it would look complete.
  Status written = create_file(public_file, key->public_key().text(), kEveryoneReads);
  if (!written) return fail(program, written.error());
  written = create_file(out, key->text(), kOwnerOnly);
  if (!written) {
    std::error_code ignored;
    fs::remove(public_file, ignored);
    return fail(program, written.error());
  }
  std::cout << out << ": secret key; " << public_file.string() << ": public key "
            << key->public_key().id() << "\n";
  return kExitDone;
}

}  // namespace

RunCommand add_keygen(CLI::App& app) {
  app.description(kKeygenDescription);
  const auto out = std::make_shared<std::string>();
  app.add_option("--out", *out, "File to write the secret key to; the public key goes to FILE.pub")
      ->required()
      ->option_text("FILE");
  return [out, program = name_of(app)] { return keygen(program, *out); };
}

}  // namespace milepost::server
