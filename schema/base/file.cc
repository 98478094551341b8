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
  return folder_of(final_path) /
         ("." + final_path.filename().string() + ".partial-" + std::to_string(::getpid()));
}

Status publish_file(const fs::path& partial, const fs::path& final_path) {
  std::error_code error;
  Status status = sync_path(partial, O_RDONLY);
  if (status.ok()) {
    fs::rename(partial, final_path, error);
    if (error) status = io_error(final_path, "cannot be replaced (" + error.message() + ")");
  }
  if (!status.ok()) {
    fs::remove(partial, error);
    return status;
  }
  return sync_path(folder_of(final_path), O_RDONLY | O_DIRECTORY);
}

Status write_text_file(const fs::path& path, std::string_view content) {
  const fs::path partial = partial_path_for(path);
  {
    std::ofstream file(partial, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) {
      const int error = errno;
      std::error_code ignored;
      fs::remove(partial, ignored);
      return io_error(path, "cannot be written (" + reason(error) + ")");
    }
  }
  return publish_file(partial, path);
}

}  // namespace milepost
