#include "server/publish/static_tree.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "schema/base/file.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPartialFile = ".partial";  // at most one, since one process writes

std::string text_of_errno(int error) { return std::generic_category().message(error); }

Error unwritable(const fs::path& file, const std::string& why) {
  return {ErrorCode::io, file.string(), "cannot be written (" + why + ")",
          "check the disk's space, the permissions and what is in the way, then run it again"};
}

bool has_content(const fs::path& file, std::string_view content) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || fs::file_size(file, error) != content.size()) {
    return false;
  }
  const Result<std::string> there = read_text_file(file);
  return there && *there == content;
}

}  // namespace

Result<StaticTree> StaticTree::open(const fs::path& folder, const std::string& first_headers) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return unwritable(folder, error.message());
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return unwritable(folder, text_of_errno(errno));
  StaticTree tree(folder, descriptor);
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return Error{ErrorCode::unavailable, folder.string(),
                 "another process publishes to this folder", "wait until it has ended"};
  }
  const Status prepared = tree.prepare(first_headers);
  if (!prepared) return prepared.error();
  return tree;
}

StaticTree::StaticTree(StaticTree&& other) noexcept
    : folder_(std::move(other.folder_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      files_(other.files_),
      written_(other.written_) {}

StaticTree::~StaticTree() {
  if (descriptor_ < 0) return;
  std::error_code ignored;
  fs::remove(folder_ / kPartialFile, ignored);
  ::close(descriptor_);
}

Status StaticTree::prepare(const std::string& first_headers) {
  std::error_code ignored;
  if (fs::is_regular_file(folder_ / kHeadersFile, ignored)) return ok_status();
  const std::vector<std::string> names = names_in("");
  // What a run leaves that was killed at once.
  const bool is_new = names.empty() || names == std::vector<std::string>{kPartialFile};
  if (is_new) return replace(folder_ / kHeadersFile, first_headers);
  return Error{ErrorCode::invalid_input, folder_.string(),
               "is neither empty nor a published tree: it has no " + std::string(kHeadersFile),
               "give another folder with --out"};
}

Status StaticTree::write(const std::string& path, std::string_view content) {
  const fs::path file = folder_ / path;
  ++files_;
  if (has_content(file, content)) return ok_status();
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) return unwritable(file, error.message());
  ++written_;
  return replace(file, content);
}

Status StaticTree::replace(const fs::path& file, std::string_view content) {
  const fs::path partial = folder_ / kPartialFile;
  std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) return unwritable(file, text_of_errno(errno));
  std::error_code error;
  fs::rename(partial, file, error);
  return error ? unwritable(file, error.message()) : ok_status();
}

Status StaticTree::sync() const {
  if (::syncfs(descriptor_) == 0) return ok_status();
  return unwritable(folder_, text_of_errno(errno));
}

std::vector<std::string> StaticTree::names_in(const std::string& path) const {
  std::error_code error;
  std::vector<std::string> names;
  fs::directory_iterator entry(folder_ / path, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

Status StaticTree::remove(const std::string& path) {
  std::error_code error;
  fs::remove_all(folder_ / path, error);
  if (!error) return ok_status();
  return Error{ErrorCode::io, (folder_ / path).string(),
               "cannot be removed (" + error.message() + ")", "check the permissions"};
}

}  // namespace milepost::server
