// A configuration file of milepost-server.
#include <cstdint>
#include <iostream>
#include <sstream>
#include <string>

#include "server/options.h"
#include "tests/fuzz/check.h"
#include "tests/fuzz/scratch_file.h"

using namespace milepost;
using namespace milepost::server;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFile file(".toml");
  file.write(data, size);
  const std::string path = file.path();
  const char* const words[] = {"milepost-server", "--config", path.c_str()};
  std::ostringstream said;
  auto* const standard_error = std::cerr.rdbuf(said.rdbuf());
  auto* const standard_output = std::cout.rdbuf(said.rdbuf());
  const auto parsed = parse_options(3, words, {});
  std::cerr.rdbuf(standard_error);
  std::cout.rdbuf(standard_output);
  if (const int* code = std::get_if<int>(&parsed)) {
    fuzz::check((*code == 0 || *code == 2) && !said.str().empty());
    return 0;
  }
  const auto& options = std::get<Options>(parsed);
  fuzz::check(said.str().empty() && !options.maps.empty() && !options.server.listen.empty());
  const ServerSettings& settings = options.server;
  fuzz::check(settings.threads >= 1 && settings.threads <= 256);
  fuzz::check(settings.disk_threads >= 1 && settings.disk_threads <= 256);
  fuzz::check(settings.hot_bytes > 0 && settings.limits.connections <= 65'536);
  fuzz::check(settings.limits.idle.count() > 0 && settings.limits.request.count() > 0);
  fuzz::check(settings.rate.requests_per_s >= 0 && settings.rate.burst >= 0);
  fuzz::check(options.tls.certificate.empty() == options.tls.key.empty());
  return 0;
}
