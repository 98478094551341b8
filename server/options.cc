#include "server/options.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <thread>

#include <CLI/CLI.hpp>

#include "schema/command/command.h"

namespace milepost::server {
namespace {

constexpr unsigned kMaxThreads = 256;

constexpr const char* kDescription =
    R"(Serves the maps of a directory over HTTP: clients in vehicles request the tiles of a segment
by range of arc length.
Every file of the directory that is a milepost map is served under its name without the extension.
Left out, each with the reason in the log, are files that cannot be served (empty, truncated,
damaged, unreadable, a name that cannot be used in a URL) and copies and partial files of maps, by
their names (town.map.bak, town.map~, town.old, town.part). Of files with the same map name the one
that ends in .map is served, or none.
The directory is watched: a file that comes, goes or takes the place of another (by renaming, never
written in place) is taken up within a second, on SIGHUP, and on directories of other hosts within
30 s. Answers under way end on the build that they began on; a build that was replaced stays for
--keep-builds-s, then it is gone (410). /readyz tells which maps are left out or damaged, and why.
Other commands, each with a --help of its own:
  milepost-server install    takes up new builds of maps in a directory
  milepost-server rollback   makes an older build the current one again
  milepost-server publish    writes maps as plain files, for an object store or a static web server
  milepost-server keygen     makes a key to sign maps with
  milepost-server sign       signs maps, for vehicles that accept no others)";

constexpr const char* kExamples = R"~(Examples:
  milepost-server --maps /srv/milepost --listen 0.0.0.0:8080
      serves on every IPv4 address of this host
  milepost-server --maps maps --listen '[::1]:8080' --threads 4
      serves on loopback over IPv6, with four threads
  milepost-server --maps maps --listen 127.0.0.1:0
      lets the system choose a port and prints it: "listening on 127.0.0.1:40123 (2 maps)", or
      "(2 maps, 1 left out)"
  milepost-server --config server.toml
      takes the same options as keys:
          maps = "/srv/milepost"
          listen = "0.0.0.0:8080"
          threads = 4
  milepost-server --maps maps --listen 127.0.0.1:8080 --check-config
      lists the maps that would be served, with their builds, and those that would be left out
  curl http://127.0.0.1:8080/v1/maps
      lists the maps; /openapi.yaml describes every path

It serves until SIGINT (Ctrl-C) or SIGTERM, then finishes responses in progress and exits with 0.
The log goes to standard error; lines that
cannot be written, because nobody reads them or the disk is full, are dropped, and the log reports
their number.
Exit codes: 0 stopped on request, 1 the address or none of the maps can be used, 2 wrong call.
A directory without any map is served as an empty catalog.)~";

// Splits "ADDR:PORT" or "[ADDR]:PORT" at the last colon. False for any other form.
bool split_listen(std::string_view text, std::string& address, std::uint16_t& port) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  std::string_view host = text.substr(0, colon);
  const std::string_view digits = text.substr(colon + 1);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return false;
  }
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  address = std::string(host);
  return error == std::errc() && end == digits.data() + digits.size();
}

unsigned default_threads() {
  return std::clamp(std::thread::hardware_concurrency(), 1U, kMaxThreads);
}

}  // namespace

std::variant<Options, int> parse_options(int argc, const char* const* argv) {
  Options options;
  options.threads = default_threads();
  std::string listen;

  CLI::App app(kDescription, "milepost-server");
  app.footer(kExamples);
  app.add_option("--maps", options.maps, "Directory of the map files")
      ->required()
      ->type_name("DIR");
  app.add_option("--listen", listen, "Address and port to listen on; port 0 lets the system choose")
      ->required()
      ->type_name("ADDR:PORT");
  add_number(app, "--threads", options.threads, "N", "Threads that answer requests", 1,
             kMaxThreads);
  unsigned keep_builds_s = 600;
  add_number(app, "--keep-builds-s", keep_builds_s, "S",
             "How long a build that was replaced or taken away is still served", 0, 604800);
  app.add_flag("--ready-needs-all", options.all_must_be_served,
               "Answer /readyz with 503 while a map is left out or damaged");
  app.add_flag(
      "--check-config", options.only_check,
      "Only check the options and list what would be served; exit code 1 if a map would be\n"
      "left out");
  app.callback([&] {
    options.keep_builds = std::chrono::seconds(keep_builds_s);
    if (!split_listen(listen, options.address, options.port)) {
      throw CLI::ValidationError("--listen " + listen,
                                 "not ADDR:PORT; write 127.0.0.1:8080 or [::1]:8080");
    }
  });
  if (const auto code = parse_command_line(app, argc, argv)) return *code;
  return options;
}

}  // namespace milepost::server
