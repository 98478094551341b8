// milepost-server: serves a directory of maps until it is stopped by a signal.
#include <fcntl.h>
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <initializer_list>
#include <iostream>
#include <string>

#include "server/catalog/reloader.h"
#include "server/commands/commands.h"
#include "server/descriptor_limit.h"
#include "server/log/log.h"
#include "server/options.h"
#include "server/server.h"

namespace {

using namespace milepost;

// Timeout for the last lines of the log when the server stops.
constexpr std::chrono::milliseconds kLastLines{500};

// Opens /dev/null for closed standard descriptors, so that no file or socket gets their numbers.
void open_standard_descriptors() {
  while (true) {
    const int descriptor = ::open("/dev/null", O_RDWR);
    if (descriptor <= STDERR_FILENO && descriptor >= 0) continue;
    if (descriptor >= 0) ::close(descriptor);
    return;
  }
}

// A log whose reader ends, or whose file reaches its size limit, does not end the server.
void ignore_failures_of_the_log() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}

// Blocks signals in this thread and those that it starts; wait_for_stop receives them.
sigset_t blocked(std::initializer_list<int> numbers) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : numbers) sigaddset(&signals, number);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void wait_for_stop(const sigset_t& signals, server::Reloader& reloader) {
  int signal = 0;
  for (sigwait(&signals, &signal); signal == SIGHUP; sigwait(&signals, &signal)) {
    spdlog::info("SIGHUP: looking at the maps");
    reloader.look();
  }
  spdlog::info("stopping on {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
}

// "(2 maps, 1 left out)"
std::string counts(const server::Catalog& catalog) {
  const std::string maps = std::to_string(catalog.maps().size()) + " maps";
  if (catalog.left_out() == 0) return '(' + maps + ')';
  return '(' + maps + ", " + std::to_string(catalog.left_out()) + " left out)";
}

server::CatalogSettings catalog_settings(const server::Options& options) {
  const server::DescriptorShares shares = server::shares_of(server::raise_descriptor_limit());
  server::CatalogSettings settings;
  settings.open_maps.maps = shares.open_maps;
  settings.open_maps.readers = options.threads;
  settings.kept.held_files = shares.held_files;
  settings.keep = options.keep_builds;
  settings.all_must_be_served = options.all_must_be_served;
  return settings;
}

// A line for each map, and for each that is left out.
Status check(const server::Options& options) {
  const auto catalog =
      server::Catalog::open(options.maps, catalog_settings(options), [](const std::string&) {});
  if (!catalog) return catalog.error();
  for (const auto& [name, map] : (*catalog)->maps())
    std::cout << name << "  build " << map->build << "  " << map->file.string() << '\n';
  for (const auto& [file, error] : (*catalog)->left_out_files())
    std::cout << "left out: " << error.line() << '\n';
  std::cout << std::flush;
  if ((*catalog)->left_out() == 0) return ok_status();
  return Error{ErrorCode::corrupt, options.maps.string(),
               std::to_string((*catalog)->left_out()) + " of its maps would be left out",
               "see the list on standard output"};
}

Status serve(const server::Options& options) {
  const auto opened =
      server::Catalog::open(options.maps, catalog_settings(options),
                            [](const std::string& line) { spdlog::warn("{}", line); });
  if (!opened) return opened.error();
  const auto catalog = std::make_shared<server::CurrentCatalog>(*opened);
  const sigset_t signals = blocked({SIGHUP, SIGINT, SIGTERM});
  const auto running =
      server::Server::start(catalog, {options.address, options.port, options.threads, {}});
  if (!running) return running.error();
  std::cout << "listening on " << (*running)->address() << ' ' << counts(**opened) << std::endl;
  server::Reloader reloader(options.maps, catalog);
  wait_for_stop(signals, reloader);
  (*running)->stop();
  return ok_status();
}

// Whether the first argument names a subcommand.
bool calls_subcommand(int argc, char** argv) {
  return argc > 1 && std::ranges::any_of(server::subcommands(), [&](const Command& command) {
           return command.name == argv[1];
         });
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_descriptors();
  if (calls_subcommand(argc, argv)) {
    return run_program("milepost-server",
                       "Serves maps; installs, rolls back, publishes and signs them.",
                       server::subcommands(), argc, argv);
  }
  const auto options = server::parse_options(argc, argv);
  if (const int* exit_code = std::get_if<int>(&options)) return *exit_code;
  ignore_failures_of_the_log();
  blocked({SIGHUP});  // from the start; SIGINT and SIGTERM may interrupt the opening of the maps
  const auto log = std::make_shared<server::LogWriter>(STDERR_FILENO);
  server::log_to(log);
  const auto& chosen = std::get<server::Options>(options);
  const Status served = chosen.only_check ? check(chosen) : serve(chosen);
  if (!served) log->write("milepost-server: " + served.error().line() + '\n');
  log->close(kLastLines);
  return served ? 0 : 1;
}
