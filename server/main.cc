// milepost-server: serves a directory of maps until it is told to stop.
#include <pthread.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <iostream>

#include "server/options.h"
#include "server/server.h"

namespace {

using namespace milepost;

void log_to_standard_error() { spdlog::set_default_logger(spdlog::stderr_logger_mt("server")); }

// The signals that ask for a stop. They are blocked in every thread and taken by wait_for_stop.
sigset_t block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void wait_for_stop(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  spdlog::info("stopping on {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
}

Status serve(const server::Options& options) {
  const auto catalog = server::Catalog::open(
      options.maps, options.threads, [](const std::string& line) { spdlog::warn("{}", line); });
  if (!catalog) return catalog.error();
  const sigset_t signals = block_stop_signals();
  const auto running =
      server::Server::start(*catalog, {options.address, options.port, options.threads, {}});
  if (!running) return running.error();
  std::cout << "listening on " << (*running)->address() << " (" << (*catalog)->maps().size()
            << " maps)" << std::endl;
  wait_for_stop(signals);
  (*running)->stop();
  return ok_status();
}

}  // namespace

int main(int argc, char** argv) {
  const auto options = server::parse_options(argc, argv);
  if (const int* exit_code = std::get_if<int>(&options)) return *exit_code;
  signal(SIGPIPE, SIG_IGN);  // a log reader that goes away does not end the server
  log_to_standard_error();
  const Status served = serve(std::get<server::Options>(options));
  if (served) return 0;
  std::cerr << "milepost-server: " << served.error().line() << '\n';
  return 1;
}
