#include "server/listen/descriptor_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

namespace milepost::server {
namespace {

constexpr std::size_t kMostConnections = 65536;

std::size_t open_descriptors() {
  std::error_code error;
  const std::filesystem::directory_iterator entries("/proc/self/fd", error);
  if (error) return 0;
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

}  // namespace

std::size_t raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return kMostConnections;
  rlimit raised = limit;
  raised.rlim_cur = limit.rlim_max;
  return ::setrlimit(RLIMIT_NOFILE, &raised) == 0 ? raised.rlim_cur : limit.rlim_cur;
}

MapDescriptors map_descriptors_within(std::size_t descriptor_limit) {
  constexpr std::size_t kMostOpenMaps = 256;
  return {descriptor_limit / 8, std::clamp<std::size_t>(descriptor_limit / 16, 1, kMostOpenMaps)};
}

std::size_t connections_within(std::size_t descriptor_limit) {
  const std::size_t open = std::min(open_descriptors(), descriptor_limit);
  return std::clamp<std::size_t>((descriptor_limit - open) / 4 * 3, 1, kMostConnections);
}

}  // namespace milepost::server
