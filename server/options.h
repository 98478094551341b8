// The command line and the configuration file of milepost-server.
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "server/catalog/catalog.h"
#include "server/log/log.h"
#include "server/server.h"
#include "server/viewer/viewer.h"

namespace milepost::server {

struct Options {
  std::filesystem::path maps;
  ServerSettings server;
  CatalogSettings catalog;  // but for what depends on the limit of descriptors
  ViewerSettings viewer;
  TlsFiles tls;                  // no paths: plain HTTP
  std::filesystem::path tokens;  // no path: everybody may ask for everything
  LogSettings log;
  bool only_check = false;  // the options and the maps
};

// The options, or the exit code if the program ends: 0 after --help and --version, 2 after a wrong
// call. Output has been printed on standard output or standard error. `inherited`: the listening
// sockets that a service manager handed over, with which --listen may be left out.
std::variant<Options, int> parse_options(int argc, const char* const* argv,
                                         const std::vector<int>& inherited);

}  // namespace milepost::server
