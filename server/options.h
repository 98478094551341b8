// The command line and the configuration file of milepost-server.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

namespace milepost::server {

struct Options {
  std::filesystem::path maps;
  std::string address;
  std::uint16_t port = 0;
  unsigned threads = 1;
  std::chrono::seconds keep_builds{600};
  bool all_must_be_served = false;
  bool only_check = false;  // the options and the maps
};

// The options, or the exit code if the program ends: 0 after --help and --version, 2 after a wrong
// call. Output has been printed on standard output or standard error.
std::variant<Options, int> parse_options(int argc, const char* const* argv);

}  // namespace milepost::server
