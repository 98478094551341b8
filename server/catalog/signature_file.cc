#include "server/catalog/signature_file.h"

#include "schema/base/file.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

Error unsigned_build(const std::string& build, const std::string& what) {
  return {ErrorCode::not_found, "build " + build, what, "sign the map with milepost-server sign"};
}

}  // namespace

fs::path signature_file_of(const fs::path& map_file) {
  fs::path file = map_file;
  return file += kSignatureExtension;
}

bool is_named_as_signature(const fs::path& file) { return file.extension() == kSignatureExtension; }

Result<StoredSignature> read_signature(const fs::path& map_file) {
  const fs::path file = signature_file_of(map_file);
  std::error_code unreachable;
  const std::uintmax_t bytes = fs::file_size(file, unreachable);
  if (unreachable == std::errc::no_such_file_or_directory) {
    return Error{ErrorCode::not_found, file.string(), "there is no such file",
                 "sign the map with milepost-server sign"};
  }
  if (unreachable) {  // a FIFO too, whose reading would block
    return Error{ErrorCode::io, file.string(), "cannot be read (" + unreachable.message() + ")",
                 "let the server's user read the file, or remove it"};
  }
  if (bytes > kMaxSignatureBytes) {
    return Error{ErrorCode::corrupt, file.string(), "is too long for a signature",
                 "sign the map again"};
  }
  Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  const Result<Signature> signature = signature_from(*text);
  if (!signature) {
    Error error = signature.error();
    error.where = file.string();
    return error;
  }
  return StoredSignature{signature->about, std::move(*text)};
}

Result<std::string> read_signature_of(const fs::path& map_file, const std::string& name,
                                      const std::string& build) {
  Result<StoredSignature> signature = read_signature(map_file);
  if (!signature && signature.error().code == ErrorCode::not_found) {
    return unsigned_build(build, "is not signed");
  }
  if (!signature) return signature.error();
  const SignedBuild& about = signature->about;
  if (about.map != name || about.build != build) {
    return unsigned_build(build, "is not signed: the signature beside the map is that of build " +
                                     about.build + " of map " + about.map);
  }
  return std::move(signature->text);
}

}  // namespace milepost::server
