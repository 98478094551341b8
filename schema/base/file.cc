#include "schema/base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

namespace milepost {
namespace fs = std::filesystem;
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

Error io_error(const fs::path& path, const std::string& what) {
  return {ErrorCode::io, path.string(), what, "check the disk's space and the permissions"};
}

class FileDescriptor {
 public:
  FileDescriptor(const fs::path& path, int flags)
      : value_(::open(path.c_str(), flags | O_CLOEXEC)) {}
  ~FileDescriptor() {
    if (value_ >= 0) ::close(value_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

Status sync_path(const fs::path& path, int flags) {
  const FileDescriptor file(path, flags);
  if (file.value() < 0 || ::fsync(file.value()) != 0) {
    return io_error(path, "cannot be written to the disk (" + reason(errno) + ")");
  }
  return ok_status();
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// The final target of a path through symbolic links; it need not exist.
fs::path followed(fs::path path) {
  constexpr int kMostLinks = 40;  // the Linux kernel's limit
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = folder_of(path) / target;
  }
  return path;
}

// Whether the file is written in place: a pipe, a device, or a file that cannot be reached by its
// own path, such as standard output as /dev/stdout.
bool is_written_in_place(const fs::path& path) {
  std::error_code ignored;
  const fs::file_type type = fs::status(path, ignored).type();
  if (type == fs::file_type::fifo || type == fs::file_type::character) return true;
  return type == fs::file_type::regular && !fs::equivalent(path, followed(path), ignored);
}

Status write_content(const fs::path& file, std::string_view content, const fs::path& named) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (stream) return ok_status();
  return io_error(named, "cannot be written (" + reason(errno) + ")");
}

}  // namespace

Result<std::string> read_text_file(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    return Error{ErrorCode::not_found, path.string(), "there is no such file", "check the path"};
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  if (!file || fs::is_directory(path, ignored)) {
    return Error{ErrorCode::io, path.string(), "cannot be read",
                 "check that it is a readable file"};
  }
  return std::move(content).str();
}

fs::path partial_path_for(const fs::path& final_path) {
  const fs::path place = followed(final_path);
  return folder_of(place) /
         ("." + place.filename().string() + ".partial-" + std::to_string(::getpid()));
}

Status publish_file(const fs::path& partial, const fs::path& final_path) {
  std::error_code error;
  const fs::path place = followed(final_path);
  Status status = sync_path(partial, O_RDONLY);
  if (status.ok() && fs::exists(place, error) && !fs::is_regular_file(place, error)) {
    status = io_error(final_path, "cannot be replaced (it is not a regular file)");
  }
  if (status.ok()) {
    fs::rename(partial, place, error);
    if (error) status = io_error(final_path, "cannot be replaced (" + error.message() + ")");
  }
  if (!status.ok()) {
    fs::remove(partial, error);
    return status;
  }
  return sync_path(folder_of(place), O_RDONLY | O_DIRECTORY);
}

Status write_text_file(const fs::path& path, std::string_view content) {
  if (is_written_in_place(path)) return write_content(path, content, path);
  const fs::path partial = partial_path_for(path);
  Status written = write_content(partial, content, path);
  if (written.ok()) return publish_file(partial, path);
  std::error_code ignored;
  fs::remove(partial, ignored);
  return written;
}

}  // namespace milepost
