#include "server/current/followed_files.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <utility>

namespace milepost::server {

FollowedFiles::FollowedFiles(std::vector<std::filesystem::path> files, std::function<Status()> load)
    : files_(std::move(files)), load_(std::move(load)), known_(identities()) {}

void FollowedFiles::look() {
  // Before they are read: what changes meanwhile is seen at the next look.
  std::vector<Identity> found = identities();
  if (found == known_) return;
  known_ = std::move(found);
  const Status loaded = load_();
  if (loaded) {
    ++loads_;
    spdlog::info("{}: was read again", files_.front().string());
  } else {
    ++failures_;
    spdlog::error("{}; what was read before stays", loaded.error().line());
  }
}

std::vector<FollowedFiles::Identity> FollowedFiles::identities() const {
  std::vector<Identity> identities;
  for (const std::filesystem::path& file : files_) {
    struct stat status {};
    Identity identity{};
    if (::stat(file.c_str(), &status) == 0) {
      identity = {static_cast<std::int64_t>(status.st_dev),
                  static_cast<std::int64_t>(status.st_ino), status.st_size, status.st_mtim.tv_sec,
                  status.st_mtim.tv_nsec};
    }
    identities.push_back(identity);
  }
  return identities;
}

}  // namespace milepost::server
