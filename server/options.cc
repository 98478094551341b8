#include "server/options.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "schema/command/command.h"
#include "server/message/cross_origin.h"

namespace milepost::server {
namespace {

constexpr unsigned kMaxThreads = 256;
constexpr unsigned kMaxSeconds = 86'400;
constexpr unsigned kMaxMegabytes = 1'048'576;

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
  milepost-server sign       signs maps, for vehicles that accept no others
  milepost-server token      makes tokens, for maps that not everybody may have)";

constexpr const char* kExamples = R"~(Examples:
  milepost-server --maps /srv/milepost --listen 0.0.0.0:8080
      serves on every IPv4 address of this host
  milepost-server --maps maps --listen '[::1]:8080' --threads 4
      serves on loopback over IPv6, with four threads
  milepost-server --maps maps --listen 127.0.0.1:0
      lets the system choose a port and prints it: "listening on 127.0.0.1:40123 (2 maps)", or
      "(2 maps, 1 left out)"
  milepost-server --maps maps --listen localhost:8080 --listen unix:/run/milepost/http
      serves on every address of localhost, and on a unix socket
  milepost-server --maps maps --listen 0.0.0.0:443 --listen plain:127.0.0.1:8080 \
      --tls-cert town.pem --tls-key town.key
      serves over TLS, and on loopback without, for a proxy or for Prometheus
  milepost-server --config server.toml
      takes the same options as keys; an unknown key is an error:
          maps = "/srv/milepost"
          listen = "0.0.0.0:8080"
          threads = 4
          log-format = "json"
  milepost-server --maps maps --listen 127.0.0.1:8080 --check-config
      lists the maps that would be served, with their builds, and those that would be left out
  curl http://127.0.0.1:8080/v1/maps
      lists the maps; /openapi.yaml describes every path

It serves until SIGINT (Ctrl-C) or SIGTERM, then finishes responses in progress and exits with 0.
Of systemd it takes listening sockets (LISTEN_FDS), and tells it when it is ready and when it stops.
The log goes to standard error; lines that cannot be written, because nobody reads them or the disk
is full, are dropped, and the log reports their number.
Exit codes: 0 stopped on request, 1 the address or none of the maps can be used, 2 wrong call.
A directory without any map is served as an empty catalog.)~";

unsigned default_threads() {
  return std::clamp(std::thread::hardware_concurrency(), 1U, kMaxThreads);
}

// What options hold as whole numbers, and settings as durations and bytes.
struct Numbers {
  unsigned keep_builds_s = 600;
  unsigned idle_s = 60;
  unsigned request_s = 10;
  unsigned stall_s = 30;
  unsigned drain_s = 5;
  unsigned memory_mb = 64;
  unsigned open_maps_mb = 128;
};

void add_limits(CLI::App& app, ConnectionLimits& limits, Numbers& numbers) {
  app.add_option(
         "--connections", limits.connections,
         "Connections at once; at the limit those that have been idle for longest are\n"
         "closed, else a new one is answered with 503 (1 to 65536, default as many as there\n"
         "are descriptors for)")
      ->check(CLI::Range(1, 65536))
      ->option_text("N");
  app.add_option("--connections-per-address", limits.per_address,
                 "The same of one client's address (1 to 65536, default half of all)")
      ->check(CLI::Range(1, 65536))
      ->option_text("N");
  add_number(app, "--idle-s", numbers.idle_s, "S", "For a client's next request", 1, kMaxSeconds);
  add_number(app, "--request-s", numbers.request_s, "S", "For a request to arrive: then 408", 1,
             kMaxSeconds);
  add_number(app, "--stall-s", numbers.stall_s, "S",
             "For a client to take the next 64 kB of a response", 1, kMaxSeconds);
  add_number(app, "--drain-s", numbers.drain_s, "S", "For responses in progress at a stop", 0,
             kMaxSeconds);
}

void add_memory(CLI::App& app, Numbers& numbers) {
  add_number(app, "--memory-mb", numbers.memory_mb, "MB",
             "Tiles and answers in memory: those that were asked for last", 1, kMaxMegabytes);
  add_number(app, "--open-maps-mb", numbers.open_maps_mb, "MB",
             "Documents and indices of maps in memory, likewise", 1, kMaxMegabytes);
}

void add_tls(CLI::App& app, TlsFiles& tls) {
  auto* certificate =
      app.add_option("--tls-cert", tls.certificate,
                     "Certificate in PEM form, followed by those that signed it: TLS on every\n"
                     "address but unix sockets and plain: ones. Read again when it changes")
          ->option_text("FILE");
  auto* key =
      app.add_option("--tls-key", tls.key, "Its private key in PEM form, without a passphrase")
          ->option_text("FILE");
  certificate->needs(key);
  key->needs(certificate);
}

void add_access(CLI::App& app, Options& options) {
  app.add_option("--tokens", options.tokens,
                 "Tokens without which nothing of a map is answered, see milepost-server token.\n"
                 "Read again when it changes (default: everybody may ask for everything)")
      ->option_text("FILE");
  app.add_option("--requests-per-s", options.server.rate.requests_per_s,
                 "Requests of one client in the long run, a token or else an address: then 429\n"
                 "(default: no limit)")
      ->check(CLI::Range(0.001, 1e6))
      ->option_text("N");
  app.add_option("--burst", options.server.rate.burst,
                 "Its requests at once after a pause (default those of ten seconds)")
      ->check(CLI::Range(1.0, 1e6))
      ->option_text("N");
  app.add_option(
         "--allow-origin", options.server.allowed_origins,
         "Origin whose pages may read what is sent, such as https://maps.example.org, or *\n"
         "for all; several may be given (default: none but the server's own)")
      ->check([](const std::string& text) {
        return is_origin(text) ? std::string()
                               : "'" + text + "' is no origin; write https://HOST, or *";
      })
      ->option_text("ORIGIN...");
}

void add_log(CLI::App& app, LogSettings& log) {
  app.add_option(
         "--log-level", log.level,
         "Least level that is logged: debug, info (default; a line a request), warn, error,\n"
         "off")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->option_text("L");
  app.add_option("--log-format", log.format, "text (default), or json: an object a line")
      ->check(CLI::IsMember({"text", "json"}))
      ->option_text("F");
}

void add_viewer(CLI::App& app, ViewerSettings& viewer) {
  app.add_option("--tiles-url", viewer.tiles_url,
                 "Map tiles beneath the network on the page at /, in Web Mercator, such as\n"
                 "https://tiles.example.org/{z}/{x}/{y}.png (default: a plain ground)")
      ->option_text("URL");
  app.add_option("--tiles-attribution", viewer.tiles_attribution,
                 "What the page says of their makers")
      ->option_text("WORDS");
}

void take(const Numbers& numbers, Options& options) {
  using std::chrono::seconds;
  constexpr std::size_t kBytesPerMb = 1'048'576;
  ConnectionLimits& limits = options.server.limits;
  limits.idle = seconds(numbers.idle_s);
  limits.request = seconds(numbers.request_s);
  limits.stall = seconds(numbers.stall_s);
  limits.drain = seconds(numbers.drain_s);
  options.server.hot_bytes = numbers.memory_mb * kBytesPerMb;
  options.catalog.open_maps.bytes = numbers.open_maps_mb * kBytesPerMb;
  options.catalog.open_maps.readers = options.server.disk_threads;
  options.catalog.keep = seconds(numbers.keep_builds_s);
}

// Throws: CLI::ParseError.
void take_addresses(const std::vector<std::string>& texts, ServerSettings& settings) {
  settings.listen.clear();
  for (const std::string& text : texts) {
    Result<ListenAddress> address = parse_listen_address(text);
    if (!address) {
      throw CLI::ValidationError("--listen " + text,
                                 address.error().what + "; " + address.error().hint);
    }
    settings.listen.push_back(std::move(*address));
  }
  if (texts.empty() && settings.inherited.empty()) throw CLI::RequiredError("--listen");
}

}  // namespace

std::variant<Options, int> parse_options(int argc, const char* const* argv,
                                         const std::vector<int>& inherited) {
  Options options;
  options.server.threads = default_threads();
  options.server.inherited = inherited;
  std::vector<std::string> listen;
  Numbers numbers;

  CLI::App app(kDescription, "milepost-server");
  app.footer(kExamples);
  app.add_option("--maps", options.maps, "Directory of the map files")
      ->required()
      ->option_text("DIR");
  app.add_option("--listen", listen,
                 "Where to listen; port 0 lets the system choose. Several may be given; none is\n"
                 "needed if systemd hands sockets over")
      ->option_text("[plain:]HOST:PORT|unix:PATH...");
  add_number(app, "--threads", options.server.threads, "N", "Threads that send and receive", 1,
             kMaxThreads);
  add_number(app, "--disk-threads", options.server.disk_threads, "N", "Threads that read maps", 1,
             kMaxThreads);
  add_memory(app, numbers);
  add_limits(app, options.server.limits, numbers);
  add_tls(app, options.tls);
  add_access(app, options);
  add_number(app, "--keep-builds-s", numbers.keep_builds_s, "S",
             "How long a build that was replaced or taken away is still served", 0, 604800);
  app.add_flag("--ready-needs-all", options.catalog.all_must_be_served,
               "Answer /readyz with 503 while a map is left out or damaged");
  add_log(app, options.log);
  add_viewer(app, options.viewer);
  app.add_flag(
      "--check-config", options.only_check,
      "Only check the options and list what would be served; exit code 1 if a map would be\n"
      "left out");
  app.callback([&] {
    take(numbers, options);
    take_addresses(listen, options.server);
  });
  if (const auto code = parse_command_line(app, argc, argv)) return *code;
  return options;
}

}  // namespace milepost::server
