#include "server/descriptor_limit.h"

#include <sys/resource.h>

#include <algorithm>

namespace milepost::server {
namespace {

constexpr std::size_t kMost = 1'048'576;  // where there is no limit
constexpr std::size_t kMostOpenMaps = 256;

}  // namespace

std::size_t raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return 1024;
  const rlim_t before = limit.rlim_cur;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, kMost);
  if (::setrlimit(RLIMIT_NOFILE, &limit) != 0) limit.rlim_cur = before;
  return std::min<rlim_t>(limit.rlim_cur, kMost);
}

DescriptorShares shares_of(std::size_t descriptors) {
  return {descriptors / 4, std::clamp<std::size_t>(descriptors / 8, 1, kMostOpenMaps)};
}

}  // namespace milepost::server
