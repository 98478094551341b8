#include "server/serve.h"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "server/catalog/reloader.h"
#include "server/listen/descriptor_limit.h"
#include "server/listen/service_manager.h"
#include "server/setup.h"

namespace milepost::server {
namespace {

CatalogSettings catalog_settings(const Options& options) {
  const MapDescriptors descriptors = map_descriptors_within(raise_descriptor_limit());
  CatalogSettings settings = options.catalog;
  settings.open_maps.maps = descriptors.open_maps;
  settings.kept.held_files = descriptors.held_files;
  return settings;
}

// Blocks signals in this thread and those that it starts; wait_for_stop receives them.
sigset_t blocked(std::initializer_list<int> numbers) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : numbers) sigaddset(&signals, number);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void wait_for_stop(const sigset_t& signals, Reloader& reloader) {
  int signal = 0;
  for (sigwait(&signals, &signal); signal == SIGHUP; sigwait(&signals, &signal)) {
    spdlog::info("SIGHUP: looking at the maps and the other files");
    reloader.look();
  }
  spdlog::info("stopping on {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
}

// "(2 maps, 1 left out)"
std::string counts(const Catalog& catalog) {
  const std::string maps = std::to_string(catalog.maps().size()) + " maps";
  if (catalog.left_out() == 0) return '(' + maps + ')';
  return '(' + maps + ", " + std::to_string(catalog.left_out()) + " left out)";
}

std::uint64_t failures(const std::vector<std::unique_ptr<FollowedFiles>>& followed) {
  std::uint64_t all = 0;
  for (const auto& files : followed) all += files->failures();
  return all;
}

void add_metrics(Metrics& metrics, const Reloader& reloader,
                 const std::vector<std::unique_ptr<FollowedFiles>>& followed,
                 const LogWriter& log) {
  using Kind = Metrics::Kind;
  metrics.add("milepost_reloads_total", "Looks at the directory that found a change.",
              Kind::counter, [&] { return static_cast<double>(reloader.reloads()); });
  metrics.add("milepost_reload_failures_total", "Looks at the directory that failed.",
              Kind::counter, [&] { return static_cast<double>(reloader.failures()); });
  metrics.add("milepost_file_failures_total",
              "Changed certificates, keys and tokens that could not be used.", Kind::counter,
              [&] { return static_cast<double>(failures(followed)); });
  metrics.add("milepost_log_lines_dropped_total", "Lines of the log that could not be written.",
              Kind::counter, [&] { return static_cast<double>(log.dropped()); });
}

void tell_service_manager(const std::string& state) {
  const Status told = notify_service_manager(state);
  if (!told) spdlog::warn("{}", told.error().line());
}

}  // namespace

Status check(const Options& options) {
  const auto setup = set_up(options);
  if (!setup) return setup.error();
  const auto catalog =
      Catalog::open(options.maps, catalog_settings(options), [](const std::string&) {});
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

Status serve(const Options& options, const LogWriter& log) {
  blocked({SIGHUP});  // from the start; SIGINT and SIGTERM may interrupt the opening of the maps
  const auto setup = set_up(options);
  if (!setup) return setup.error();
  const auto opened = Catalog::open(options.maps, catalog_settings(options),
                                    [](const std::string& line) { spdlog::warn("{}", line); });
  if (!opened) return opened.error();
  const auto catalog = std::make_shared<CurrentCatalog>(*opened);
  const sigset_t signals = blocked({SIGHUP, SIGINT, SIGTERM});
  const auto running = Server::start(catalog, setup->settings);
  if (!running) return running.error();
  for (const std::string& address : (*running)->addresses())
    std::cout << "listening on " << address << ' ' << counts(**opened) << std::endl;
  Reloader reloader(options.maps, catalog, {}, [&followed = setup->followed] {
    for (const auto& files : followed) files->look();
  });
  add_metrics((*running)->metrics(), reloader, setup->followed, log);
  tell_service_manager("READY=1");
  wait_for_stop(signals, reloader);
  tell_service_manager("STOPPING=1");
  (*running)->stop();
  return ok_status();
}

}  // namespace milepost::server
