#include "schema/store/held_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace milepost {
namespace {

Error error_of(const std::filesystem::path& file, int number) {
  if (number == ENOENT || number == ENOTDIR) {
    return {ErrorCode::not_found, file.string(), "there is no such file", "check the path"};
  }
  const bool is_full = number == EMFILE || number == ENFILE;
  return {ErrorCode::io, file.string(),
          "cannot be opened (" + std::generic_category().message(number) + ")",
          is_full ? "raise the limit of open files" : "check the permissions"};
}

std::int64_t nanoseconds_of(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

FileIdentity identity_from(const struct stat& status) {
  return {status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size),
          nanoseconds_of(status.st_mtim), nanoseconds_of(status.st_ctim)};
}

}  // namespace

Result<FileIdentity> identity_of(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return error_of(file, errno);
  return identity_from(status);
}

Result<HeldFile> HeldFile::open(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return error_of(file, errno);
  HeldFile held(file, descriptor);
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return error_of(file, errno);
  held.identity_ = identity_from(status);
  return held;
}

HeldFile::~HeldFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace milepost
