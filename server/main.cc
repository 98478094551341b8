// milepost-server: serves a directory of maps until it is stopped by a signal.
#include <fcntl.h>
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <csignal>
#include <initializer_list>
#include <iostream>
#include <string>

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

void wait_for_stop(const sigset_t& signals) {
  int signal = 0;
  for (sigwait(&signals, &signal); signal == SIGHUP; sigwait(&signals, &signal)) {
    spdlog::warn("SIGHUP: the maps are not read again; restart the server to serve new ones");
  }
  spdlog::info("stopping on {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
}

// "(2 maps, 1 left out)"
std::string counts(const server::Catalog& catalog) {
  const std::string maps = std::to_string(catalog.maps().size()) + " maps";
  if (catalog.left_out() == 0) return '(' + maps + ')';
  return '(' + maps + ", " + std::to_string(catalog.left_out()) + " left out)";
}

Status serve(const server::Options& options) {
  const auto catalog = server::Catalog::open(
      options.maps, options.threads, [](const std::string& line) { spdlog::warn("{}", line); });
  if (!catalog) return catalog.error();
  const sigset_t signals = blocked({SIGHUP, SIGINT, SIGTERM});
  server::ServerSettings settings;
  settings.listen = {{options.address, options.port}};
  settings.threads = options.threads;
  const auto running =
      server::Server::start(std::make_shared<server::CurrentCatalog>(*catalog), settings);
  if (!running) return running.error();
  std::cout << "listening on " << (*running)->address() << ' ' << counts(**catalog) << std::endl;
  wait_for_stop(signals);
  (*running)->stop();
  return ok_status();
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_descriptors();
  const auto options = server::parse_options(argc, argv);
  if (const int* exit_code = std::get_if<int>(&options)) return *exit_code;
  ignore_failures_of_the_log();
  blocked({SIGHUP});  // from the start; SIGINT and SIGTERM may interrupt the opening of the maps
  const auto log = std::make_shared<server::LogWriter>(STDERR_FILENO);
  server::log_to(log);
  const Status served = serve(std::get<server::Options>(options));
  if (!served) log->write("milepost-server: " + served.error().line() + '\n');
  log->close(kLastLines);
  return served ? 0 : 1;
}
