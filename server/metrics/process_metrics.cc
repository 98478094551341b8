#include "server/metrics/process_metrics.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace milepost::server {
namespace {

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

std::vector<ProcessNumber> process_numbers() {
  static const double started_s = seconds_since_1970();
  std::vector<ProcessNumber> numbers = {
      {"process_start_time_seconds", "Seconds since 1970 when the counts began.", started_s}};
  std::size_t pages = 0;
  std::size_t resident_pages = 0;
  if (std::ifstream("/proc/self/statm") >> pages >> resident_pages) {
    const auto page_bytes = static_cast<double>(::sysconf(_SC_PAGESIZE));
    numbers.push_back({"process_resident_memory_bytes", "Memory in use.",
                       static_cast<double>(resident_pages) * page_bytes});
  }
  std::error_code error;
  const std::filesystem::directory_iterator descriptors("/proc/self/fd", error);
  if (!error) {
    numbers.push_back({"process_open_fds", "Open descriptors.",
                       static_cast<double>(std::distance(begin(descriptors), end(descriptors)))});
  }
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) == 0)
    numbers.push_back(
        {"process_max_fds", "Descriptors at most.", static_cast<double>(limit.rlim_cur)});
  return numbers;
}

}  // namespace milepost::server
