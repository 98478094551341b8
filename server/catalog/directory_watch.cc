#include "server/catalog/directory_watch.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace milepost::server {

Result<DirectoryWatch> DirectoryWatch::open(const std::filesystem::path& directory) {
  const auto failed = [&] {
    return Error{ErrorCode::io, directory.string(),
                 "cannot be watched (" + std::generic_category().message(errno) + ")",
                 "send SIGHUP after a change, or wait for the next look"};
  };
  DirectoryWatch watch(directory, ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (watch.descriptor_ < 0) return failed();
  constexpr std::uint32_t kEvents = IN_CLOSE_WRITE | IN_MOVED_FROM | IN_MOVED_TO | IN_DELETE |
                                    IN_CREATE | IN_ATTRIB | IN_DELETE_SELF | IN_MOVE_SELF;
  if (::inotify_add_watch(watch.descriptor_, directory.c_str(), kEvents) < 0) return failed();
  return watch;
}

DirectoryWatch::~DirectoryWatch() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool DirectoryWatch::take(DirectoryChanges& changes) {
  alignas(inotify_event) std::array<char, 16384> events{};
  ssize_t bytes = 0;
  bool any = false;
  while ((bytes = ::read(descriptor_, events.data(), events.size())) > 0) {
    any = true;
    for (ssize_t at = 0; at < bytes;) {
      const auto* const event = reinterpret_cast<const inotify_event*>(events.data() + at);
      if (event->len > 0) {
        changes.files.insert(directory_ / event->name);
      } else {  // the directory itself, or too much at once
        changes.may_be_more = true;
      }
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
    }
  }
  return any;
}

}  // namespace milepost::server
